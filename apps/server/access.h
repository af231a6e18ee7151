// Who may talk to the server: those that know the token, from pages of the server's own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace motes::server {

/// 128 bits from the system's generator, as 32 hexadecimal digits. Throws Error if there are none.
std::string make_token();

/// Whether the texts are the same, in a time that tells at most their lengths.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Names under which the server is reached: what Host may say. A page of somebody else's name that
/// the browser was led to take for this machine's (DNS rebinding) is refused by it, as is one of
/// another origin.
class HostNames {
 public:
  /// Loopback names, the address that is listened on and `others`, as the user gives them, without
  /// ports; where the address is one of all, also this machine's own name.
  HostNames(std::string_view address, const std::vector<std::string>& others);

  /// Whether a request with these headers comes from a page of the server's own or from no page.
  /// Empty: there is no such header.
  bool accept(std::string_view host, std::string_view origin) const;

 private:
  bool knows(std::string_view name) const;

  std::vector<std::string> names_;   ///< lower case, without port and brackets
  std::vector<std::string> others_;  ///< of these, what a proxy may stand for
};

/// The name in "NAME:PORT", "[ADDRESS]:PORT" or without the port, in lower case; "" if it is none.
std::string host_name(std::string_view authority);

}  // namespace motes::server
