// The server: listens, and gives each connection what it is allowed to have.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/options.h"

namespace motes::server {

class Files;
class Studio;

class Server {
 public:
  /// Listens at once. `studio`, which is stopped with the server, and `files` must outlive it.
  /// Throws Error where the address cannot be listened on.
  Server(const ServerOptions& options, Studio& studio, Files& files);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// What has to be known to use the server.
  const std::string& token() const;
  /// The page's address, token and all.
  std::string url() const;

  /// Serves until stop().
  void run();
  /// Says goodbye to the clients and makes run() return. From any thread.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace motes::server
