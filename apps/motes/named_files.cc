#include "motes/named_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/error.h"

namespace motes {
namespace {

/// One name for all paths to a file; what cannot be looked at stays as it is.
std::filesystem::path canonical_name(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path canonical = weakly_canonical(path, error);
  return error ? path : canonical;
}

}  // namespace

void refuse_same_file(const NamedFiles& outputs, const NamedFiles::value_type& input) {
  for (auto second = outputs.begin(); second != outputs.end(); ++second) {
    if (second->second.empty()) continue;
    const auto refuse = [&](const NamedFiles::value_type& first) {
      if (canonical_name(first.second) != canonical_name(second->second)) return;
      throw Error(first.second, fmt::format("is both {} and {}; expected two different files",
                                            first.first, second->first));
    };
    refuse(input);
    std::for_each(outputs.begin(), second, refuse);
  }
}

}  // namespace motes
