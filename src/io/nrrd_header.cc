// Definition of NRRD file format: teem.sourceforge.net/nrrd/format.html
#include "io/nrrd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "core/error.h"
#include "io/text.h"

namespace motes {

namespace {

constexpr std::size_t num_axes = 3;

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::optional<ScalarType> scalar_type(std::string_view name) {
  static const std::map<std::string_view, ScalarType> types{
      {"signed char", ScalarType::int8},
      {"int8", ScalarType::int8},
      {"int8_t", ScalarType::int8},
      {"uchar", ScalarType::uint8},
      {"unsigned char", ScalarType::uint8},
      {"uint8", ScalarType::uint8},
      {"uint8_t", ScalarType::uint8},
      {"short", ScalarType::int16},
      {"short int", ScalarType::int16},
      {"signed short", ScalarType::int16},
      {"signed short int", ScalarType::int16},
      {"int16", ScalarType::int16},
      {"int16_t", ScalarType::int16},
      {"ushort", ScalarType::uint16},
      {"unsigned short", ScalarType::uint16},
      {"unsigned short int", ScalarType::uint16},
      {"uint16", ScalarType::uint16},
      {"uint16_t", ScalarType::uint16},
      {"int", ScalarType::int32},
      {"signed int", ScalarType::int32},
      {"int32", ScalarType::int32},
      {"int32_t", ScalarType::int32},
      {"uint", ScalarType::uint32},
      {"unsigned int", ScalarType::uint32},
      {"uint32", ScalarType::uint32},
      {"uint32_t", ScalarType::uint32},
      {"longlong", ScalarType::int64},
      {"long long", ScalarType::int64},
      {"long long int", ScalarType::int64},
      {"signed long long", ScalarType::int64},
      {"signed long long int", ScalarType::int64},
      {"int64", ScalarType::int64},
      {"int64_t", ScalarType::int64},
      {"ulonglong", ScalarType::uint64},
      {"unsigned long long", ScalarType::uint64},
      {"unsigned long long int", ScalarType::uint64},
      {"uint64", ScalarType::uint64},
      {"uint64_t", ScalarType::uint64},
      {"float", ScalarType::float32},
      {"double", ScalarType::float64},
  };
  const auto it = types.find(name);
  return it == types.end() ? std::nullopt : std::optional(it->second);
}

std::optional<NrrdEncoding> encoding_of(std::string_view name) {
  if (name == "raw") return NrrdEncoding::raw;
  if (name == "txt" || name == "text" || name == "ascii") return NrrdEncoding::text;
  if (name == "gz" || name == "gzip" || name == "bz2" || name == "bzip2") {
    return NrrdEncoding::compressed;
  }
  return std::nullopt;
}

/// The fields by their names without blanks, for "data file" is "datafile" too.
const std::set<std::string>& known_fields() {
  static const std::set<std::string> fields{
      "dimension", "type", "encoding", "endian", "sizes", "content", "space", "spacedimension",
      "spacedirections", "spaceorigin", "spaceunits", "spacings", "axismins", "axismaxs", "centers",
      "centerings", "kinds", "units", "datafile", "lineskip", "byteskip",
      // Those that say nothing of where samples are or what they are.
      "labels", "thicknesses", "number", "blocksize", "min", "max", "oldmin", "oldmax",
      "sampleunits", "measurementframe"};
  return fields;
}

class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view content)
      : path_(path), lines_(path, {content, 1}, true) {}

  NrrdHeader parse() {
    const std::string_view magic = lines_.next("NRRD0001 to NRRD0005");
    const bool known =
        magic.size() == 8 && magic.starts_with("NRRD000") && magic[7] >= '1' && magic[7] <= '5';
    if (!known) {
      lines_.fail(fmt::format("expected NRRD0001 to NRRD0005, found '{}'", printable(magic)));
    }
    read_fields();
    header_.end = lines_.position();
    header_.end_line = lines_.rest().first_line;
    parse_storage();
    parse_dims();
    place_samples();
    if (const Field* field = find("content")) header_.shape.name = field->text;
    if (header_.shape.name.empty()) header_.shape.name = "value";
    return header_;
  }

 private:
  struct Field {
    std::string text;
    std::uint64_t line = 0;
  };

  /// Up to a blank line, or the end of a header that is a file of its own.
  void read_fields() {
    while (!lines_.rest().text.empty()) {
      const std::string_view line = lines_.next("");
      if (trim(line).empty()) return;
      if (line.starts_with('#')) continue;
      const std::size_t colon = line.find(':');
      if (colon == std::string_view::npos) {
        lines_.fail(fmt::format("expected 'FIELD: VALUE', found '{}'", printable(line)));
      }
      if (line.substr(colon).starts_with(":=")) continue;  // a key and value of the user's
      std::string name = lower_case(trim(line.substr(0, colon)));
      std::erase(name, ' ');
      if (!known_fields().contains(name)) {
        const std::vector<std::string> names(known_fields().begin(), known_fields().end());
        lines_.fail(unknown_name("field of the header", trim(line.substr(0, colon)), names).what());
      }
      fields_[name] = {std::string(trim(line.substr(colon + 1))), lines_.line()};
    }
    if (find("datafile") == nullptr) {
      throw Error(path_, "ends in its header; expected a blank line and the values");
    }
  }

  const Field* find(const std::string& name) const {
    const auto it = fields_.find(name);
    return it == fields_.end() ? nullptr : &it->second;
  }

  const Field& need(const std::string& name) const {
    const Field* field = find(name);
    if (field == nullptr) {
      throw Error(path_, fmt::format("has a header without '{}:'; expected one", name));
    }
    return *field;
  }

  [[noreturn]] void fail(const Field& field, std::string_view expected) const {
    throw Error(path_, field.line,
                fmt::format("expected {}, found '{}'", expected, printable(field.text)));
  }

  void parse_storage() {
    const Field& type = need("type");
    const auto scalar = scalar_type(lower_case(type.text));
    if (!scalar) fail(type, "a type of numbers, such as float");
    header_.type = *scalar;
    const Field& encoding = need("encoding");
    const auto kind = encoding_of(lower_case(encoding.text));
    if (!kind) fail(encoding, "the encoding raw, gzip, bzip2 or ascii");
    header_.encoding = *kind;
    if (const Field* endian = find("endian")) {
      const std::string order = lower_case(endian->text);
      if (order != "little" && order != "big") fail(*endian, "the byte order little or big");
      header_.big_endian = order == "big";
    } else if (size_of(header_.type) > 1 && header_.encoding != NrrdEncoding::text) {
      need("endian");
    }
    if (const Field* file = find("datafile")) parse_data_file(*file);
    parse_skips();
  }

  void parse_data_file(const Field& field) {
    const bool several =
        field.text.starts_with("LIST") || field.text.find('%') != std::string::npos;
    if (several || field.text.empty()) fail(field, "one file of values");
    header_.data_file = field.text;
  }

  void parse_skips() {
    if (const Field* lines = find("lineskip")) {
      const auto count = to_count(lines->text);
      if (!count) fail(*lines, "a number of lines");
      header_.line_skip = *count;
    }
    if (const Field* bytes = find("byteskip")) {
      const auto count = to_integer(bytes->text);
      const std::int64_t least = header_.encoding == NrrdEncoding::raw ? -1 : 0;
      if (!count || *count < least) fail(*bytes, "a number of bytes");
      header_.byte_skip = *count;
    }
  }

  void parse_dims() {
    const Field& dimension = need("dimension");
    if (to_count(dimension.text) != num_axes) {
      fail(dimension, "3 axes of space and one number a sample");
    }
    const Field& sizes = need("sizes");
    const auto tokens = split_tokens(sizes.text);
    if (tokens.size() != num_axes) fail(sizes, "3 sizes");
    for (std::size_t axis = 0; axis < num_axes; ++axis) {
      const auto n = to_count(tokens[axis]);
      if (!n || *n == 0) fail(sizes, "3 sizes of at least 1");
      header_.shape.dims[axis] = *n;
    }
    if (const Field* kinds = find("kinds")) {
      for (const std::string_view token : split_tokens(kinds->text)) {
        const std::string kind = lower_case(token);
        if (kind != "domain" && kind != "space" && kind != "none" && kind != "???") {
          fail(*kinds, "axes of the kind domain or space");
        }
      }
    }
  }

  /// Origin and steps: the vectors of a space, or what older files say of each axis.
  void place_samples() {
    Grid& shape = header_.shape;
    if (const Field* dimension = find("spacedimension");
        dimension != nullptr && to_count(dimension->text) != num_axes) {
      fail(*dimension, "a space of 3 dimensions");
    }
    if (const Field* directions = find("spacedirections")) {
      const auto vectors = parse_vectors(*directions, num_axes);
      std::copy(vectors.begin(), vectors.end(), shape.steps.begin());
      if (const Field* origin = find("spaceorigin")) {
        shape.origin = Point3d{} + parse_vectors(*origin, 1)[0];
      }
      take_unit("spaceunits");
    } else {
      place_by_axes();
      take_unit("units");
    }
  }

  /// "(1,0,0) (0,1,0) (0,0,1)", with or without blanks inside.
  std::vector<Vector3d> parse_vectors(const Field& field, std::size_t count) const {
    std::vector<double> numbers;
    std::string_view left = trim(field.text);
    bool good = true;
    while (good && !left.empty()) {
      const std::size_t end = left.find(')');
      good = left.front() == '(' && end != std::string_view::npos;
      if (!good) break;
      std::string inside(left.substr(1, end - 1));
      std::replace(inside.begin(), inside.end(), ',', ' ');
      const auto tokens = split_tokens(inside);
      good = tokens.size() == num_axes;
      for (const std::string_view token : tokens) {
        const auto value = to_real(token);
        good = good && value;
        numbers.push_back(value.value_or(0));
      }
      left = trim(left.substr(end + 1));
    }
    if (!good || numbers.size() != num_axes * count) {
      fail(field, count == 1 ? "a vector (x,y,z)" : "3 vectors (x,y,z), one an axis");
    }
    std::vector<Vector3d> vectors;
    for (std::size_t i = 0; i < numbers.size(); i += num_axes) {
      vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    }
    return vectors;
  }

  /// A number an axis; nan where a file leaves it open.
  std::optional<std::array<double, num_axes>> axis_numbers(const std::string& name) const {
    const Field* field = find(name);
    if (field == nullptr) return std::nullopt;
    std::array<double, num_axes> values{};
    const auto tokens = split_tokens(field->text);
    bool good = tokens.size() == num_axes;
    for (std::size_t axis = 0; good && axis < num_axes; ++axis) {
      const auto value = to_real(tokens[axis]);
      good = value.has_value();
      values[axis] = value.value_or(0);
    }
    if (!good) fail(*field, "3 numbers");
    return values;
  }

  /// Whether the samples of an axis are the middles of cells between its minimum and maximum, which
  /// is so where nothing is said.
  bool is_cell_centered(std::size_t axis) const {
    const Field* field = find("centers") != nullptr ? find("centers") : find("centerings");
    if (field == nullptr) return true;
    const auto tokens = split_tokens(field->text);
    return axis >= tokens.size() || lower_case(tokens[axis]) != "node";
  }

  /// Spacings, minima and maxima of the axes; a step of 1 from 0 on where nothing is said.
  void place_by_axes() {
    Grid& shape = header_.shape;
    const auto spacings = axis_numbers("spacings"), mins = axis_numbers("axismins"),
               maxs = axis_numbers("axismaxs");
    for (std::size_t axis = 0; axis < num_axes; ++axis) {
      const bool cell = is_cell_centered(axis);
      const double low = mins && std::isfinite((*mins)[axis]) ? (*mins)[axis] : 0;
      double step = 1;
      if (spacings && std::isfinite((*spacings)[axis])) {
        step = (*spacings)[axis];
      } else if (mins && maxs) {
        const auto n = static_cast<double>(shape.dims[axis]);
        step = ((*maxs)[axis] - low) / (cell ? n : std::max(n - 1, 1.0));
      }
      const int a = static_cast<int>(axis);
      shape.steps[axis][a] = step;
      shape.origin[a] = mins && cell ? low + step / 2 : low;
    }
  }

  /// The unit of all axes, in quotes, if they have one and the same.
  void take_unit(const std::string& name) {
    const Field* field = find(name);
    if (field == nullptr) return;
    std::vector<std::string> units;
    for (std::string_view left = field->text; left.find('"') != std::string_view::npos;) {
      left.remove_prefix(left.find('"') + 1);
      units.emplace_back(left.substr(0, left.find('"')));
      left.remove_prefix(std::min(left.size(), units.back().size() + 1));
    }
    const bool same = units.size() == num_axes && units[0] == units[1] && units[1] == units[2];
    if (same && !units[0].empty()) header_.shape.length_unit = units[0];
  }

  const std::filesystem::path& path_;
  LineReader lines_;
  std::map<std::string, Field> fields_;
  NrrdHeader header_;
};

}  // namespace

NrrdHeader parse_nrrd_header(const std::filesystem::path& path, std::string_view content) {
  return HeaderParser(path, content).parse();
}

}  // namespace motes
