// What the user of `motes view` may choose of the server.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace motes::server {

/// How long the server waits for a client before it leaves it.
struct Timeouts {
  std::chrono::milliseconds request{15'000};  ///< for a request's header whole, or for a next one
  std::chrono::milliseconds upload{30'000};   ///< for more of a file
  /// For an answer or a message to be taken whole, and for a frame to be acknowledged.
  std::chrono::milliseconds taking{120'000};
  /// For a word on a socket; after half of it there is a ping, which any browser answers, and which
  /// keeps proxies from cutting the line.
  std::chrono::milliseconds silence{40'000};
};

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< to listen on
  std::uint16_t port = 0;             ///< 0: one that is free
  std::string base_url = "/";         ///< path under which a proxy shows the server
  std::vector<std::string> hosts;     ///< further names under which it is reached
  std::string token;                  ///< that clients must know; empty: a random one
  std::size_t max_clients = 16;
  std::uint64_t max_upload_bytes = std::uint64_t{4} << 30;
  std::uint64_t max_kept_bytes = std::uint64_t{16} << 30;  ///< of all uploads, on the disk
  /// Of HTTP, and as many more that are refused.
  double requests_per_second = 100, request_burst = 200;
  Timeouts timeouts;
};

}  // namespace motes::server
