// Numbers by an exact short cut where there is one, by the standard library where not.
#include "io/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>

namespace motes {

namespace {

const char* token_end(const char* begin, const char* end) {
  while (begin != end && !is_blank(*begin)) ++begin;
  return begin;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Any number that std::from_chars reads, and those beyond the range of double as strtod does.
const char* parse_real_slowly(const char* begin, const char* end, double& value) {
  end = token_end(begin, end);
  const char* first = begin != end && *begin == '+' ? begin + 1 : begin;
  if (first != begin && first != end && *first == '-') return nullptr;
  const auto [stop, error] = std::from_chars(first, end, value);
  if (stop != end || error == std::errc::invalid_argument) return nullptr;
  if (error == std::errc::result_out_of_range) {
    value = std::strtod(std::string(first, end).c_str(), nullptr);
  }
  return end;
}

constexpr std::array<double, 23> exact_powers_of_ten{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

}  // namespace

const char* parse_real(const char* begin, const char* end, double& value) {
  const char* p = begin;
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;

  // The digits as one integer, and the power of ten that belongs to it.
  std::uint64_t digits = 0;
  int exponent = 0;
  const char* first = p;
  for (; p != end && is_digit(*p); ++p) digits = 10 * digits + static_cast<unsigned>(*p - '0');
  std::ptrdiff_t num_digits = p - first;
  if (p != end && *p == '.') {
    const char* fraction = ++p;
    for (; p != end && is_digit(*p); ++p) digits = 10 * digits + static_cast<unsigned>(*p - '0');
    exponent = static_cast<int>(fraction - p);
    num_digits += p - fraction;
  }
  // 19 digits cannot have overflowed.
  if (num_digits == 0 || num_digits > 19) return parse_real_slowly(begin, end, value);
  if (p != end && (*p == 'e' || *p == 'E')) {
    const char* e = p + 1;
    const bool negative_exponent = e != end && *e == '-';
    if (e != end && (*e == '-' || *e == '+')) ++e;
    const char* e_first = e;
    int written = 0;
    for (; e != end && is_digit(*e) && e - e_first < 4; ++e) written = 10 * written + (*e - '0');
    if (e == e_first) return parse_real_slowly(begin, end, value);
    exponent += negative_exponent ? -written : written;
    p = e;
  }
  if (p != end && !is_blank(*p)) return parse_real_slowly(begin, end, value);

  // Both factors are exact doubles here, so one operation rounds correctly (Clinger 1990).
  const std::uint64_t largest_exact = std::uint64_t{1} << 53;
  if (digits > largest_exact || exponent < -22 || exponent > 22) {
    return parse_real_slowly(begin, end, value);
  }
  const auto whole = static_cast<double>(digits);
  const double magnitude = exponent < 0
                               ? whole / exact_powers_of_ten[static_cast<std::size_t>(-exponent)]
                               : whole * exact_powers_of_ten[static_cast<std::size_t>(exponent)];
  value = negative ? -magnitude : magnitude;
  return p;
}

const char* parse_integer(const char* begin, const char* end, std::int64_t& value) {
  if (begin != end && *begin == '+' && begin + 1 != end && is_digit(begin[1])) ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || (stop != end && !is_blank(*stop))) return nullptr;
  return stop;
}

std::optional<double> to_real(std::string_view token) {
  double value = 0;
  const char* end = token.data() + token.size();
  if (token.empty() || parse_real(token.data(), end, value) != end) return std::nullopt;
  return value;
}

std::optional<std::int64_t> to_integer(std::string_view token) {
  std::int64_t value = 0;
  const char* end = token.data() + token.size();
  if (token.empty() || parse_integer(token.data(), end, value) != end) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> to_count(std::string_view text) {
  const auto count = to_integer(trim(text));
  if (!count || *count < 0) return std::nullopt;
  return static_cast<std::uint64_t>(*count);
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view next_token(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  const char* end = token_end(text.data(), text.data() + text.size());
  const auto token = text.substr(0, static_cast<std::size_t>(end - text.data()));
  text.remove_prefix(token.size());
  return token;
}

std::vector<std::string_view> split_tokens(std::string_view text) {
  std::vector<std::string_view> tokens;
  for (auto token = next_token(text); !token.empty(); token = next_token(text)) {
    tokens.push_back(token);
  }
  return tokens;
}

void warn_of_open_end(const std::filesystem::path& file, std::uint64_t line, Warnings* warnings) {
  if (warnings == nullptr) return;
  warnings->add(Error(file, line, "the last line has no end; it may be cut short").what());
}

LineReader::LineReader(const std::filesystem::path& file, TextBlock block, bool complete)
    : file_(file), text_(block.text), next_line_(block.first_line), complete_(complete) {}

std::string_view LineReader::peek() const {
  const std::string_view rest = text_.substr(position_);
  std::string_view line = rest.substr(0, rest.find('\n'));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string_view LineReader::next(std::string_view expected) {
  if (position_ == text_.size()) {
    throw TextEnds(file_, next_line_, fmt::format("the file ends here; expected {}", expected));
  }
  const std::string_view line = peek();
  position_ += line.size();
  // (the line's end may be "\r\n", and the last line may have none)
  position_ = std::min(text_.find('\n', position_), text_.size() - 1) + 1;
  ++next_line_;
  return line;
}

std::string_view LineReader::next_filled(std::string_view expected) {
  std::string_view line = next(expected);
  while (trim(line).empty()) line = next(expected);
  return line;
}

void LineReader::skip(std::uint64_t count, std::string_view what) {
  const char* const end = text_.data() + text_.size();
  const char* p = text_.data() + position_;
  std::uint64_t skipped = 0;
  for (; skipped < count && p != end; ++skipped) {
    const void* newline = std::memchr(p, '\n', static_cast<std::size_t>(end - p));
    p = newline == nullptr ? end : static_cast<const char*>(newline) + 1;
  }
  position_ = static_cast<std::size_t>(p - text_.data());
  next_line_ += skipped;
  if (skipped < count) fail_short(skipped, count, what);
}

void LineReader::fail_short(std::uint64_t found, std::uint64_t count, std::string_view what) {
  throw TextEnds(file_, next_line_,
                 fmt::format("the file ends after {} of {} {}", found, count, what));
}

void LineReader::skip_rest() {
  if (!complete_) throw TextEnds(file_, next_line_, "the file ends here");
  while (position_ != text_.size()) next("");
}

TextBlock LineReader::take_rows(std::uint64_t count, std::string_view what) {
  const TextBlock start = rest();
  const std::size_t begin = position_;
  for (std::uint64_t found = 0; found < count;) {
    if (position_ == text_.size()) fail_short(found, count, what);
    const std::string_view line = next("");
    if (is_row(line.data(), line.data() + line.size())) ++found;
  }
  return {start.text.substr(0, position_ - begin), start.first_line};
}

bool LineReader::skip_blank_lines() {
  const std::string_view rest = text_.substr(position_);
  const auto filled = std::find_if_not(rest.begin(), rest.end(), is_blank);
  const bool found = filled != rest.end();
  const std::string_view blank(rest.begin(), filled);
  const std::string_view lines = found ? blank.substr(0, blank.rfind('\n') + 1) : blank;
  next_line_ += static_cast<std::uint64_t>(std::count(lines.begin(), lines.end(), '\n'));
  if (!lines.empty() && lines.back() != '\n') ++next_line_;
  position_ += lines.size();
  if (!found && !complete_) throw TextEnds(file_, next_line_, "the file ends here");
  return found;
}

std::uint64_t LineReader::parse_count(std::string_view text, std::string_view what) const {
  const auto count = to_count(text);
  if (!count) fail(fmt::format("expected {}, found '{}'", what, printable(trim(text))));
  return *count;
}

void LineReader::fail(const std::string& message) const { throw Error(file_, line(), message); }

}  // namespace motes
