// A parser for the Python dictionary that is the header: literals only, nothing is evaluated.
#include "io/npy_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "core/error.h"

namespace motes {

namespace {

class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view text)
      : path_(path), text_(text) {}

  NpyHeader parse();

 private:
  [[noreturn]] void fail(std::string_view expected) const {
    throw Error(path_, fmt::format("has a header that is not NumPy's: expected {} at '{}'",
                                   expected, printable(text_.substr(0, 30))));
  }
  void skip_blanks() {
    const std::size_t n = text_.find_first_not_of(" \t\n\r");
    text_.remove_prefix(std::min(n, text_.size()));
  }
  bool accept(char c) {
    skip_blanks();
    if (!text_.starts_with(c)) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(fmt::format("'{}'", c));
  }
  std::string parse_string();
  std::size_t parse_number();
  bool parse_bool();
  std::vector<std::size_t> parse_tuple();
  NpyField parse_type();
  void parse_fields(NpyHeader& header);

  const std::filesystem::path& path_;
  std::string_view text_;
};

std::string HeaderParser::parse_string() {
  skip_blanks();
  const char quote = text_.empty() ? '\0' : text_.front();
  if (quote != '\'' && quote != '"') fail("a string");
  const std::size_t end = text_.find(quote, 1);
  if (end == std::string_view::npos) fail("the end of a string");
  std::string value(text_.substr(1, end - 1));
  text_.remove_prefix(end + 1);
  return value;
}

std::size_t HeaderParser::parse_number() {
  skip_blanks();
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
  if (error != std::errc{}) fail("a number");
  text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
  if (text_.starts_with('L')) text_.remove_prefix(1);  // Python 2 wrote long numbers so
  return value;
}

bool HeaderParser::parse_bool() {
  skip_blanks();
  for (const std::string_view word : {"True", "False"}) {
    if (!text_.starts_with(word)) continue;
    text_.remove_prefix(word.size());
    return word == "True";
  }
  fail("True or False");
}

std::vector<std::size_t> HeaderParser::parse_tuple() {
  std::vector<std::size_t> values;
  expect('(');
  while (!accept(')')) {
    values.push_back(parse_number());
    if (!accept(',')) {
      expect(')');
      break;
    }
  }
  return values;
}

/// "<f4" and the like.
NpyField HeaderParser::parse_type() {
  const std::string type = parse_string();
  const std::string expected = fmt::format(
      "has values of type '{}'; expected numbers or text, such as '<f4'", printable(type));
  if (type.size() < 3) throw Error(path_, expected);
  NpyField field;
  const bool native_is_big = std::endian::native == std::endian::big;
  field.big_endian = type[0] == '>' || (type[0] == '=' && native_is_big);
  field.kind = type[1];
  const auto [end, error] = std::from_chars(type.data() + 2, type.data() + type.size(), field.size);
  if (error != std::errc{} || end != type.data() + type.size()) throw Error(path_, expected);
  const std::size_t n = field.size;
  constexpr std::size_t longest_text = 4096;
  const bool number = n == 1 || n == 2 || n == 4 || n == 8;
  const bool known = (field.kind == 'f' && (n == 4 || n == 8)) ||
                     ((field.kind == 'i' || field.kind == 'u') && number) ||
                     (field.kind == 'b' && n == 1) ||
                     (field.is_text() && n > 0 && n <= longest_text);
  if (!known) throw Error(path_, expected);
  if (field.kind == 'U') field.size *= 4;
  return field;
}

/// [('x', '<f4'), ('v', '<f8', (3,)), ...]
void HeaderParser::parse_fields(NpyHeader& header) {
  constexpr std::size_t most_values = 1024;
  header.structured = true;
  std::size_t num_values = 0;
  while (!accept(']')) {
    expect('(');
    const std::string name = parse_string();
    expect(',');
    NpyField field = parse_type();
    field.name = name;
    field.offset = header.item_size;
    if (accept(',')) {
      for (const std::size_t n : parse_tuple()) field.count *= std::min(n, most_values);
      accept(',');
    }
    expect(')');
    num_values += field.count;
    if (field.count > most_values || num_values > most_values) fail("at most 1024 values an item");
    header.item_size += field.size * field.count;
    // Fields without a name are padding.
    if (!name.empty()) header.fields.push_back(std::move(field));
    accept(',');
  }
}

NpyHeader HeaderParser::parse() {
  NpyHeader header;
  bool has_type = false, has_order = false, has_shape = false;
  expect('{');
  while (!accept('}')) {
    const std::string key = parse_string();
    expect(':');
    if (key == "descr") {
      has_type = true;
      if (accept('[')) {
        parse_fields(header);
      } else {
        header.fields = {parse_type()};
        header.item_size = header.fields[0].size;
      }
    } else if (key == "fortran_order") {
      has_order = true;
      header.fortran_order = parse_bool();
    } else if (key == "shape") {
      has_shape = true;
      header.shape = parse_tuple();
    } else {
      fail("descr, fortran_order or shape");
    }
    accept(',');
  }
  if (!has_type || !has_order || !has_shape) fail("descr, fortran_order and shape before the end");
  if (!header.structured && header.fields[0].is_text()) fail("numbers as values");
  return header;
}

/// Little-endian, as the format has it.
std::size_t load_length(std::string_view bytes) {
  std::size_t length = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    length = length << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return length;
}

}  // namespace

std::string NpyHeader::shape_text() const { return fmt::format("({})", fmt::join(shape, ", ")); }

NpyHeader parse_npy_header(const std::filesystem::path& path, std::string_view content) {
  constexpr std::size_t magic_bytes = 6, version_bytes = 2;
  const std::size_t lengths_at = magic_bytes + version_bytes;
  const int version = content.size() > lengths_at ? content[magic_bytes] : 0;
  if (!content.starts_with("\x93NUMPY") || version < 1 || version > 3) {
    throw Error(path, "is not an array of NumPy's; expected format version 1, 2 or 3");
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  const std::size_t begin = lengths_at + length_bytes;
  if (content.size() < begin) throw Error(path, "ends in its header");
  const std::size_t length = load_length(content.substr(lengths_at, length_bytes));
  if (content.size() - begin < length) throw Error(path, "ends in its header");

  NpyHeader header = HeaderParser(path, content.substr(begin, length)).parse();
  header.data_offset = begin + length;
  const std::size_t stored = content.size() - header.data_offset;
  // In floating point, so that no product of lengths can overflow.
  double expected = static_cast<double>(header.item_size);
  for (const std::size_t n : header.shape) expected *= static_cast<double>(n);
  if (static_cast<double>(stored) != expected) {
    throw Error(path, fmt::format("holds {} bytes of values; expected {:.0f} for the shape {}",
                                  stored, expected, header.shape_text()));
  }
  return header;
}

}  // namespace motes
