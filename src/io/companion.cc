#include "io/companion.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <atomic>
#include <system_error>

#include "core/error.h"

namespace motes {
namespace {

std::atomic<bool> kept = false;

}  // namespace

void keep_to_own_directories() {
  if (kept.exchange(true)) return;
  H5open();
  H5Lunregister(H5L_TYPE_EXTERNAL);
}

bool keeps_to_own_directories() { return kept; }

std::filesystem::path companion_of(const std::filesystem::path& file,
                                   const std::filesystem::path& name) {
  std::filesystem::path companion = file.parent_path() / name;
  if (!kept) return companion;
  const auto directory_of = [](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(path, error).parent_path();
  };
  if (directory_of(companion) != directory_of(file)) {
    throw Error(file, fmt::format("refers to {}, which is not opened from here; expected a file "
                                  "beside it",
                                  printable(name.string())));
  }
  return companion;
}

}  // namespace motes
