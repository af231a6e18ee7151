// Who may talk to the server: those that know the token, from pages of the server's own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/asio.h"

namespace motes::server {

/// 128 bits from the system's generator, as 32 hexadecimal digits. Throws Error if there are none.
std::string make_token();
/// Throws Error for a token of the user's, from `origin`, that could be guessed or that would not
/// stand in an address as it is.
void check_token(std::string_view token, std::string_view origin);

/// Whether the texts are the same, in a time that tells at most their lengths.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// The address to listen on that the user means by `text`: one of IP, also in brackets, or
/// "localhost". Throws Error for what is none.
asio::ip::address listening_address(std::string_view text);

/// Names under which the server is reached: what Host may say. A page of somebody else's name that
/// the browser was led to take for this machine's (DNS rebinding) is refused by it, as is one of
/// another origin.
class HostNames {
 public:
  /// Loopback names, the address that is listened on and `others`, as the user gives them, without
  /// ports; where that is all addresses, also this machine's own name and any address: those
  /// cannot be rebound.
  HostNames(const asio::ip::address& address, const std::vector<std::string>& others);

  /// Why a request with these headers comes neither from a page of the server's own nor from no
  /// page; "": it does. Empty headers: there are none.
  std::string refusal(std::string_view host, std::string_view origin) const;

 private:
  bool knows(const std::string& name) const;

  std::vector<std::string> names_;   ///< lower case, without port and brackets
  std::vector<std::string> others_;  ///< of these, what a proxy may stand for
  bool any_address_ = false;
};

/// This machine's own name; "" if it has none.
std::string machine_name();

/// The name in "NAME:PORT", "[ADDRESS]:PORT" or without the port, in lower case; "" if it is none.
std::string host_name(std::string_view authority);

}  // namespace motes::server
