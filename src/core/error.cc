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

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_letter_or_digit(char c) {
  return (lower(c) >= 'a' && lower(c) <= 'z') || (c >= '0' && c <= '9');
}

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), lower);
  return out;
}

/// Insertions, deletions, substitutions and swaps of neighbours that make `b` of `a` (optimal
/// string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row.back();
}

/// Whether `part` is in `whole`; a part of one or two letters has to stand by itself, as the q of
/// v_q does.
bool is_part(std::string_view part, std::string_view whole) {
  if (part.empty()) return false;
  for (auto at = whole.find(part); at != whole.npos; at = whole.find(part, at + 1)) {
    const auto end = at + part.size();
    const bool alone = (at == 0 || !is_letter_or_digit(whole[at - 1])) &&
                       (end == whole.size() || !is_letter_or_digit(whole[end]));
    if (part.size() > 2 || alone) return true;
  }
  return false;
}

/// Of the candidates that `counts` allows, the one that takes the fewest edits.
/// `counts(known, distance)` gets it in lower case.
template <class Predicate>
std::string best_word(const std::string& wanted, const std::vector<std::string>& candidates,
                      Predicate&& counts) {
  std::string best;
  std::size_t best_distance = std::string::npos;
  for (const std::string& candidate : candidates) {
    const std::string known = in_lower_case(candidate);
    const std::size_t distance = edit_distance(wanted, known);
    if (distance >= best_distance || !counts(known, distance)) continue;
    best_distance = distance;
    best = candidate;
  }
  return best;
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string wanted = in_lower_case(word);
  // A single letter that is changed leaves nothing of the word.
  const std::size_t far = wanted.size() < 2 ? 0 : std::max<std::size_t>(1, wanted.size() / 3);
  return best_word(wanted, candidates, [&](const std::string& known, std::size_t distance) {
    const bool near = distance <= far && distance < known.size();
    return near || is_part(wanted, known) || is_part(known, wanted);
  });
}

std::string closest_word(std::string_view word, const std::vector<std::string>& candidates) {
  return best_word(in_lower_case(word), candidates,
                   [](const std::string&, std::size_t) { return true; });
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
