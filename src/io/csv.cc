// Tables of text with or without a header: comma, semicolon, tab or blanks between the values.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/in_memory.h"
#include "io/table.h"
#include "io/type_names.h"

namespace motes {

namespace {

/// Stands for a blank inside a value, so that blanks can separate values in the end.
constexpr char inner_blank = '\x7f';

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

bool is_comment(std::string_view line) { return trim(line).starts_with('#'); }

/// The separator of a line of values: the first of these that is in it.
char find_separator(std::string_view line) {
  for (const char c : {';', ',', '\t'}) {
    if (line.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

/// Rewrites one line in place: comments vanish, blanks separate values, quotes are gone and blanks
/// inside values are marked.
/// Returns false if a value in the middle is empty.
bool normalize_line(char* begin, char* end, char separator) {
  if (is_comment({begin, end})) {
    std::fill(begin, end, ' ');
    return true;
  }
  if (separator == ' ') return true;
  bool quoted = false, full = true;
  char* last = nullptr;  // of the value's characters
  for (char* c = begin; c != end; ++c) {
    if (*c == '"') {
      quoted = !quoted;
      *c = ' ';
    } else if (*c == separator && !quoted) {
      full = full && last != nullptr;
      last = nullptr;
      *c = ' ';
    } else if (!is_blank(*c)) {
      if (last != nullptr) std::fill(last + 1, c, inner_blank);
      last = c;
    }
  }
  return full;
}

void normalize(const std::filesystem::path& path, std::string& content, char separator) {
  std::uint64_t line = 1;
  for (std::size_t begin = 0; begin < content.size(); ++line) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    if (!normalize_line(content.data() + begin, content.data() + end, separator)) {
      throw Error(path, line, "has an empty value; expected one between any two separators");
    }
    begin = end + 1;
  }
}

bool is_number(std::string_view token) { return to_real(token).has_value(); }

/// The first lines of a table: names of columns, if it has a header, and where its rows begin.
struct Opening {
  std::vector<std::string> names;
  TextBlock rows;
  std::vector<std::string_view> first_row;
};

/// Names in a comment right above the rows, as NumPy's savetxt writes them; or none.
std::vector<std::string> names_in_comment(std::string_view comment, std::size_t num_columns) {
  std::string text(comment.substr(comment.find_first_not_of("# \t")));
  normalize_line(text.data(), text.data() + text.size(), find_separator(text));
  const std::vector<std::string_view> tokens = split_tokens(text);
  if (tokens.size() != num_columns || std::any_of(tokens.begin(), tokens.end(), is_number)) {
    return {};
  }
  return {tokens.begin(), tokens.end()};
}

/// `normalized` is the text after normalize(), `original` what was above its first row before.
Opening find_opening(const std::filesystem::path& path, std::string_view original,
                     std::string_view normalized) {
  Opening opening;
  std::string_view comment;
  std::uint64_t line = 1;
  for (std::size_t begin = 0; begin < normalized.size(); ++line) {
    const std::string_view text = first_line(normalized.substr(begin));
    const std::vector<std::string_view> tokens = split_tokens(text);
    if (tokens.empty()) {
      const std::string_view raw = first_line(original.substr(std::min(begin, original.size())));
      if (raw.find_first_not_of("# \t\r") != std::string_view::npos) comment = raw;
    } else if (opening.names.empty() && std::none_of(tokens.begin(), tokens.end(), is_number)) {
      opening.names.assign(tokens.begin(), tokens.end());
    } else {
      opening.rows = {normalized.substr(begin), line};
      opening.first_row = tokens;
      if (opening.names.empty() && !comment.empty()) {
        opening.names = names_in_comment(comment, tokens.size());
      }
      return opening;
    }
    begin += text.size() + 1;
  }
  throw Error(path, line, "ends here; expected rows with the coordinates of particles");
}

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Which columns have the meanings that Motes knows.
struct Roles {
  std::array<std::size_t, 3> position{none, none, none};
  std::size_t species = none, id = none;
};

std::size_t find_column(const std::vector<std::string>& names,
                        std::initializer_list<std::string_view> candidates) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = lower_case(names[i]);
    if (std::find(candidates.begin(), candidates.end(), name) != candidates.end()) return i;
  }
  return none;
}

Roles find_roles(const std::filesystem::path& path, const Opening& opening) {
  Roles roles;
  const std::vector<std::string>& names = opening.names;
  roles.species = find_column(names, {"species", "element", "symbol", "type", "atom", "name"});
  roles.id = find_column(names, {"id", "ids", "particle_id"});
  // ParaView writes vectors as Points:0 to 2.
  roles.position = {find_column(names, {"x", "pos_x", "position_x", "points:0"}),
                    find_column(names, {"y", "pos_y", "position_y", "points:1"}),
                    find_column(names, {"z", "pos_z", "position_z", "points:2"})};
  const auto num_found = std::count_if(roles.position.begin(), roles.position.end(),
                                       [](std::size_t column) { return column != none; });
  if (num_found == 3) return roles;
  if (num_found > 0) throw Error(path, "has not all of the columns x, y and z; expected the three");

  // Nobody says which they are: the first three numbers.
  std::size_t axis = 0;
  for (std::size_t i = 0; i < opening.first_row.size() && axis < 3; ++i) {
    if (i == roles.species || i == roles.id) continue;
    if (is_number(opening.first_row[i])) {
      roles.position[axis++] = i;
    } else if (roles.species == none && names.empty()) {
      roles.species = i;
    }
  }
  if (axis < 3) {
    throw Error(path, opening.rows.first_line, "has fewer than three numbers; expected x, y and z");
  }
  return roles;
}

bool is_logical(std::string_view token) {
  const std::string lower = lower_case(token);
  return lower == "true" || lower == "false";
}

std::vector<Column> make_columns(const Opening& opening, const Roles& roles) {
  std::vector<Column> columns(opening.first_row.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string_view token = opening.first_row[i];
    const bool position = std::count(roles.position.begin(), roles.position.end(), i) > 0;
    columns[i].name = opening.names.empty() ? fmt::format("column{}", i + 1) : opening.names[i];
    if (position) {
      columns[i].kind = Column::Kind::real;
    } else if (i == roles.species) {
      columns[i].kind = Column::Kind::word;
    } else if (i == roles.id && to_integer(token)) {
      columns[i].kind = Column::Kind::integer;
    } else if (is_number(token)) {
      columns[i].kind = Column::Kind::single;
    } else if (is_logical(token)) {
      columns[i].kind = Column::Kind::logical;
    }
  }
  return columns;
}

std::size_t count_rows(std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    const std::string_view line = first_line(text);
    count += trim(line).empty() ? 0 : 1;
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return count;
}

ParticleSet make_particles(const std::filesystem::path& path, std::vector<Column> columns,
                           const Roles& roles, const ReadOptions& options) {
  ParticleSet particles;
  particles.length_unit = "unknown";
  set_positions(particles, columns[roles.position[0]].reals, columns[roles.position[1]].reals,
                columns[roles.position[2]].reals);
  for (Column& column : columns) {
    if (column.kind == Column::Kind::single || column.kind == Column::Kind::logical) {
      particles.properties.push_back({column.name, std::move(column.singles)});
    } else if (column.kind == Column::Kind::integer) {
      particles.ids = std::move(column.integers);
    } else if (column.kind == Column::Kind::word) {
      for (std::string& word : column.words) {
        std::replace(word.begin(), word.end(), inner_blank, ' ');
      }
      name_types(path, column, {}, options, particles);
    }
  }
  return particles;
}

std::unique_ptr<Trajectory> open_csv(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  std::string content = read_decompressed(path, options);
  if (content.find('\0') != std::string::npos) {
    throw Error(path, "is not a text; expected a table of numbers");
  }
  if (content.starts_with("\xef\xbb\xbf")) content.replace(0, 3, "   ");  // byte order mark
  // The separator is that of the first row; comments are left as they are until then.
  std::string_view rest = content;
  while (!rest.empty() && (trim(first_line(rest)).empty() || is_comment(first_line(rest)))) {
    rest.remove_prefix(std::min(first_line(rest).size() + 1, rest.size()));
  }
  const char separator = find_separator(first_line(rest));
  const std::string original(content, 0, content.size() - rest.size());
  const bool has_last_end = content.ends_with('\n');
  normalize(path, content, separator);
  const Opening opening = find_opening(path, original, content);
  if (!opening.names.empty() && opening.names.size() != opening.first_row.size()) {
    throw Error(path, opening.rows.first_line,
                fmt::format("has {} values; expected {}, as many as names in the header",
                            opening.first_row.size(), opening.names.size()));
  }
  const Roles roles = find_roles(path, opening);
  std::vector<Column> columns = make_columns(opening, roles);
  parse_table(path, opening.rows, count_rows(opening.rows.text), RowWidth::exact, columns, options);
  std::vector<ParticleSet> frames;
  frames.push_back(make_particles(path, std::move(columns), roles, options));
  // Only now: where reading fails, its error says more.
  if (!has_last_end && options.warnings != nullptr) {
    options.warnings->add(
        fmt::format("{}: the last line has no end; it may be cut short", printable(path.string())));
  }
  return std::make_unique<InMemoryTrajectory>("CSV", path, std::move(frames));
}

/// A header that names x, y and z, or two rows of as many numbers.
bool matches_csv(std::string_view head) {
  if (head.find('\0') != std::string_view::npos) return false;
  std::vector<std::vector<std::string>> rows;
  while (!head.empty() && rows.size() < 2) {
    std::string line(first_line(head));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    if (trim(line).empty() || is_comment(line)) continue;
    if (!normalize_line(line.data(), line.data() + line.size(), find_separator(line))) return false;
    const std::vector<std::string_view> tokens = split_tokens(line);
    rows.emplace_back(tokens.begin(), tokens.end());
  }
  if (rows.size() < 2 || rows[0].size() != rows[1].size() || rows[0].size() < 3) return false;
  const auto numeric = [](const std::vector<std::string>& row) {
    return std::all_of(row.begin(), row.end(), [](const std::string& t) { return is_number(t); });
  };
  const bool named = find_column(rows[0], {"x"}) != none && find_column(rows[0], {"y"}) != none &&
                     find_column(rows[0], {"z"}) != none;
  return named || (numeric(rows[0]) && numeric(rows[1]));
}

}  // namespace

const Format& csv_format() {
  static const Format format{"CSV", {".csv", ".tsv", ".txt"}, matches_csv, open_csv};
  return format;
}

}  // namespace motes
