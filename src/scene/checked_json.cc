// Checks of single JSON values and of JSON as such.
#include "scene/checked_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "core/error.h"
#include "scene/transfer_function.h"

namespace motes {
namespace {

using nlohmann::json;

constexpr std::uintmax_t max_file_bytes = std::uintmax_t{16} << 20;
constexpr int max_depth = 32;  // of nesting; a scene needs 7

std::string describe(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  return printable(value.dump(-1, ' ', false, json::error_handler_t::replace), 40);
}

/// Where keys stand that people look for elsewhere; those that are in one place alone.
constexpr struct {
  std::string_view key, place;
} places[] = {
    {"style", "the scene itself"},
    {"size", "render"},
    {"select", "a field, or balls or sticks of geometry"},
    {"points", "a field's transfer_function"},
    {"grid", "a field"},
    {"eye", "camera"},
    {"target", "camera"},
    {"fov", "camera"},
    {"orthographic", "camera"},
    {"frame", "data"},
    {"types", "data"},
    {"support_factor", "kernel"},
    {"kernel_scale", "kernel"},
    {"isosurfaces", "a field"},
    {"transfer_function", "a field"},
    {"weight", "a field"},
    {"normalise", "a field"},
    {"interpolation", "a field's grid"},
    {"array", "a field's grid"},
    {"extinction", "a field's transfer_function"},
    {"bonds", "sticks of geometry"},
    {"step_size", "render"},
    {"termination_opacity", "render"},
    {"lighting", "render"},
    {"clip_planes", "render"},
    {"background", "render"},
    {"engine", "render"},
    {"lights", "render.lighting"},
    {"direction", "a light of render.lighting.lights"},
    {"intensity", "a light of render.lighting.lights"},
    {"antialiasing", "render.surface"},
    {"ambient_occlusion", "render.surface"},
    {"occlusion_distance", "render.surface"},
    {"shadows", "render.surface"},
    {"light_angle", "render.surface"},
};

/// Refuses what JSON allows but no scene has: deep nesting, a key twice in one object.
class Guard {
 public:
  bool operator()(int depth, json::parse_event_t event, json& parsed) {
    if (depth > max_depth) throw Error(fmt::format("nested more than {} deep", max_depth));
    if (event == json::parse_event_t::object_start) keys_.emplace_back();
    if (event == json::parse_event_t::object_end) keys_.pop_back();
    if (event == json::parse_event_t::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!keys_.back().insert(key).second) {
        throw Error(fmt::format("the key '{}' is there twice in one object", printable(key)));
      }
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

}  // namespace

void CheckedJson::fail(const std::string& what) const {
  throw Error(key_.empty() ? what : fmt::format("{}: {}", key_, what));
}

void CheckedJson::expected(std::string_view what) const {
  fail(fmt::format("expected {}, found {}", what, describe(value_)));
}

void CheckedJson::check_keys(const std::vector<std::string>& known) const {
  if (!value_.is_object()) expected("an object");
  for (const auto& item : value_.items()) {
    if (std::find(known.begin(), known.end(), item.key()) == known.end()) {
      const auto* const place = std::find_if(std::begin(places), std::end(places),
                                             [&](const auto& p) { return p.key == item.key(); });
      if (place != std::end(places)) {
        fail(fmt::format("the key '{}' belongs in {}", item.key(), place->place));
      }
      std::string what = unknown_name("key", item.key(), known).what();
      if (nearest_word(item.key(), known).empty()) {
        what += fmt::format("; the nearest known key is '{}'", closest_word(item.key(), known));
      }
      fail(what);
    }
  }
}

CheckedJson CheckedJson::at(const char* key) const {
  if (!has(key)) fail(fmt::format("expected the key '{}'", key));
  return {value_.at(key), key_.empty() ? key : key_ + "." + key};
}

bool CheckedJson::boolean() const {
  if (!value_.is_boolean()) expected("true or false");
  return value_.get<bool>();
}

double CheckedJson::number() const {
  if (!value_.is_number() || !std::isfinite(value_.get<double>())) expected("a number");
  return value_.get<double>();
}

double CheckedJson::number_above(double limit) const {
  const std::string what = fmt::format("a number greater than {}", limit);
  if (!value_.is_number()) expected(what);
  const double v = number();
  if (!(v > limit)) expected(what);
  return v;
}

double CheckedJson::number_from_zero() const {
  if (!value_.is_number() || !(number() >= 0)) expected("a number of 0 or more");
  return number();
}

std::uint64_t CheckedJson::integer(std::uint64_t low, std::uint64_t high) const {
  if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() < low ||
      value_.get<std::uint64_t>() > high) {
    expected(high == std::numeric_limits<std::uint64_t>::max()
                 ? fmt::format("a whole number of {} or more", low)
                 : fmt::format("a whole number from {} to {}", low, high));
  }
  return value_.get<std::uint64_t>();
}

std::string CheckedJson::text(std::string_view what) const {
  if (!value_.is_string() || value_.get_ref<const std::string&>().empty()) expected(what);
  return value_.get<std::string>();
}

std::vector<CheckedJson> CheckedJson::array(std::string_view what) const {
  if (!value_.is_array()) expected(what);
  std::vector<CheckedJson> items;
  items.reserve(value_.size());
  for (std::size_t i = 0; i < value_.size(); ++i) {
    items.emplace_back(value_[i], fmt::format("{}[{}]", key_, i));
  }
  return items;
}

std::vector<CheckedJson> CheckedJson::array_of(std::size_t size, std::string_view what) const {
  if (!value_.is_array() || value_.size() != size) expected(what);
  return array(what);
}

Vector3d CheckedJson::vector() const {
  const auto items = array_of(3, "an array of three numbers");
  return {items[0].number(), items[1].number(), items[2].number()};
}

Color CheckedJson::color() const {
  constexpr const char* what =
      "a colour, \"black\", \"white\", \"#rrggbb\" (sRGB) or [r, g, b] (linear, 0 or more)";
  if (value_.is_string()) {
    const auto srgb = color_from_text(value_.get_ref<const std::string&>());
    if (!srgb) expected(what);
    return *srgb;
  }
  const auto items = array_of(3, what);
  const auto channel = [](const CheckedJson& v) {
    return static_cast<float>(v.number_from_zero());
  };
  const Color c{channel(items[0]), channel(items[1]), channel(items[2])};
  if (!std::isfinite(c.r + c.g + c.b)) expected(what);
  return c;
}

json parse_json(std::string_view text, const std::filesystem::path& path) {
  try {
    Guard guard;
    return json::parse(text.begin(), text.end(),
                       [&guard](int depth, json::parse_event_t event, json& parsed) {
                         return guard(depth, event, parsed);
                       });
  } catch (const json::parse_error& error) {
    const auto line =
        1 +
        std::count(text.begin(),
                   text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size())),
                   '\n');
    // What the library says after its own account of the place.
    std::string_view what = error.what();
    for (const std::string_view mark : {"column ", ": "}) {
      if (const auto at = what.find(mark); at != std::string_view::npos) {
        what.remove_prefix(at + mark.size());
      }
    }
    throw Error(path, static_cast<std::uint64_t>(line),
                fmt::format("expected JSON: {}", printable(what, 200)));
  } catch (const json::exception& error) {
    throw Error(path, fmt::format("expected JSON: {}", printable(error.what(), 200)));
  } catch (const Error& error) {
    throw Error(path, error.what());
  }
}

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw Error(path, "expected a file, found a directory");
  if (!std::filesystem::exists(path, error) && !error) throw Error(path, "there is no such file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path, "cannot be opened");
  std::string text;
  char block[65536];
  while (stream.read(block, sizeof block) || stream.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(stream.gcount()));
    if (text.size() > max_file_bytes) {
      throw Error(path, fmt::format("expected at most {} MiB", max_file_bytes >> 20));
    }
  }
  if (stream.bad()) throw Error(path, "cannot be read");
  return text;
}

}  // namespace motes
