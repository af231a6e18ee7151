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

void check_token(std::string_view token, std::string_view origin) {
  constexpr std::size_t shortest = 16;
  const auto is_plain = [](unsigned char c) {
    return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_' || c == '~');
  };
  if (token.size() >= shortest && std::all_of(token.begin(), token.end(), is_plain)) return;
  throw Error(fmt::format("{}: expected at least {} of the characters A-Z a-z 0-9 - . _ ~", origin,
                          shortest));
}

asio::ip::address listening_address(std::string_view text) {
  const std::string address = without_brackets(text);
  if (address == "localhost") return asio::ip::address_v4::loopback();
  boost::system::error_code error;
  auto found = asio::ip::make_address(address, error);
  if (!error) return found;
  throw Error(fmt::format(
      "--address {}: expected an IP address of this machine, 0.0.0.0 for all of them, or localhost",
      printable(text, 100)));
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

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

HostNames::HostNames(const asio::ip::address& address, const std::vector<std::string>& others)
    : names_{"127.0.0.1", "localhost", "::1", address.to_string()},
      any_address_(address.is_unspecified()) {
  for (const std::string& name : others) others_.push_back(without_brackets(name));
  names_.insert(names_.end(), others_.begin(), others_.end());
  if (any_address_) names_.push_back(lower(machine_name()));
}

bool HostNames::knows(const std::string& name) const {
  if (contains(names_, name)) return true;
  boost::system::error_code error;
  asio::ip::make_address(name, error);
  return any_address_ && !error;
}

std::string HostNames::refusal(std::string_view host, std::string_view origin) const {
  const auto unknown = [](const std::string& name) {
    return fmt::format(
        "the server is not known as '{0}': if it is to be, give motes view --host {0}",
        printable(name, 100));
  };
  const std::string name = host_name(host);
  if (name.empty()) return "expected the name of a host";
  if (!knows(name)) return unknown(name);
  if (origin.empty()) return "";
  const auto scheme = origin.find("://");
  // "null" is of sandboxed pages and files.
  if (scheme == origin.npos) return "this is not asked for by the server's own page";
  const std::string_view authority = origin.substr(scheme + 3);
  if (lower(authority) == lower(host)) return "";
  // A proxy may have changed the Host, but the user has named it.
  const std::string proxy = host_name(authority);
  if (contains(others_, proxy)) return "";
  return knows(proxy) ? "this is not asked for by the server's own page" : unknown(proxy);
}

}  // namespace motes::server
