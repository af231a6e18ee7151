#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace motes {

Error::Error(const std::string& message) : std::runtime_error(message) {}

Error::Error(const std::filesystem::path& file, const std::string& message)
    : std::runtime_error(fmt::format("{}: {}", printable(file.string(), 4096), message)) {}

Error::Error(const std::filesystem::path& file, std::uint64_t line, const std::string& message)
    : std::runtime_error(fmt::format("{}:{}: {}", printable(file.string(), 4096), line, message)) {}

std::string printable(std::string_view text, std::size_t max_length) {
  std::string out;
  for (const char c : text) {
    if (out.size() >= max_length) return out + "...";
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out;
}

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substitution, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  // A word that shares less than half of its letters is no help.
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

Error unknown_name(std::string_view kind, std::string_view name,
                   const std::vector<std::string>& candidates) {
  const std::string start = fmt::format("unknown {} '{}'", kind, printable(name));
  const std::string nearest = nearest_word(name, candidates);
  if (!nearest.empty())
    return Error(fmt::format("{}; did you mean '{}'?", start, printable(nearest)));
  if (candidates.empty()) return Error(fmt::format("{}; there is none here", start));
  std::string list;
  for (const std::string& candidate : candidates) {
    list += (list.empty() ? "" : ", ") + printable(candidate);
  }
  return Error(fmt::format("{}; there are: {}", start, printable(list, 200)));
}

}  // namespace motes
