// What the user of `motes view` may choose of the server.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace motes::server {

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< to listen on
  std::uint16_t port = 0;             ///< 0: one that is free
  std::string base_url = "/";         ///< path under which a proxy shows the server
  std::vector<std::string> hosts;     ///< further names under which it is reached
  std::string token;                  ///< that clients must know; empty: a random one
  std::size_t max_clients = 16;
  std::uint64_t max_upload_bytes = std::uint64_t{4} << 30;
};

}  // namespace motes::server
