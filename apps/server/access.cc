// Tokens and names.
#include "server/access.h"

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>

#include "core/error.h"

namespace motes::server {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string without_brackets(std::string_view address) {
  if (address.size() > 2 && address.front() == '[' && address.back() == ']') {
    address = address.substr(1, address.size() - 2);
  }
  return lower(address);
}

bool is_port(std::string_view text) {
  return text.size() <= 5 && std::all_of(text.begin(), text.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string make_token() {
  std::array<std::uint8_t, 16> bytes{};
  // Up to 256 bytes come whole or not at all.
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw Error("cannot make a token: the system gives no random numbers");
  }
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    asm volatile("" : "+r"(difference));  // the compiler must not leave the loop early
  }
  return difference == 0;
}

std::string host_name(std::string_view authority) {
  const auto colon =
      authority.starts_with('[') ? authority.find(':', authority.find(']')) : authority.find(':');
  if (colon != authority.npos && !is_port(authority.substr(colon + 1))) return "";
  return without_brackets(authority.substr(0, colon));
}

HostNames::HostNames(std::string_view address, const std::vector<std::string>& others)
    : names_{"127.0.0.1", "localhost", "::1", without_brackets(address)} {
  for (const std::string& name : others) others_.push_back(without_brackets(name));
  names_.insert(names_.end(), others_.begin(), others_.end());
  if (address != "0.0.0.0" && address != "::") return;
  std::array<char, 256> own{};
  if (gethostname(own.data(), own.size() - 1) == 0) names_.push_back(lower(own.data()));
}

bool HostNames::knows(std::string_view name) const { return contains(names_, std::string(name)); }

bool HostNames::accept(std::string_view host, std::string_view origin) const {
  const std::string name = host_name(host);
  if (name.empty() || !knows(name)) return false;
  if (origin.empty()) return true;
  const auto scheme = origin.find("://");
  if (scheme == origin.npos) return false;  // also "null", of sandboxed pages and files
  const std::string_view authority = origin.substr(scheme + 3);
  if (lower(authority) == lower(host)) return true;
  // A proxy may have changed the Host, but the user has named it.
  return contains(others_, host_name(authority));
}

}  // namespace motes::server
