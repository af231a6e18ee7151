// JSON whose values are checked as they are read, with messages that name the key. For the .cc
// files of this room alone: the library behind it is heavy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/color.h"
#include "core/vec.h"

namespace motes {

/// One value with the path of keys that leads to it, as in "fields[0].radius". All that it throws
/// is Error "KEY: expected ..., found ...". Does not own the JSON.
class CheckedJson {
 public:
  CheckedJson(const nlohmann::json& value, std::string key) : value_(value), key_(std::move(key)) {}

  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void expected(std::string_view what) const;

  /// Throws unless this is an object that has no other keys than `known`.
  void check_keys(const std::vector<std::string>& known) const;
  bool has(const char* key) const { return value_.contains(key); }
  /// The value of `key`; throws where there is none.
  CheckedJson at(const char* key) const;
  /// Calls `read` with the value of `key` if there is one.
  template <class F>
  void with(const char* key, F&& read) const {
    if (has(key)) read(at(key));
  }

  bool boolean() const;
  /// Finite.
  double number() const;
  double number_above(double limit) const;
  double number_from_zero() const;
  std::uint64_t integer(std::uint64_t low, std::uint64_t high) const;
  /// Not empty. `what` says in the message what is expected.
  std::string text(std::string_view what) const;
  std::vector<CheckedJson> array(std::string_view what) const;
  /// The same of at most `most` items of a kind, such as "lights"; `read` makes a T of each.
  template <class T>
  std::vector<T> few(std::string_view what, std::size_t most, T (*read)(const CheckedJson&)) const {
    const auto items = array("an array of " + std::string(what));
    if (items.size() > most) {
      expected("an array of at most " + std::to_string(most) + " " + std::string(what));
    }
    std::vector<T> out;
    out.reserve(items.size());
    for (const CheckedJson& item : items) out.push_back(read(item));
    return out;
  }
  std::vector<CheckedJson> array_of(std::size_t size, std::string_view what) const;
  Vector3d vector() const;
  /// "black", "white", "#rrggbb" or three linear numbers of 0 or more.
  Color color() const;

  const std::string& key() const { return key_; }
  const nlohmann::json& raw() const { return value_; }

 private:
  const nlohmann::json& value_;
  std::string key_;
};

/// Throws Error that names the file and the line; refuses deep nesting and keys that are there
/// twice.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path& path);

/// The whole of a file of JSON. Throws Error, also where it is larger than any scene.
std::string read_text(const std::filesystem::path& path);

}  // namespace motes
