// The server: listens, and gives each connection what it is allowed to have.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

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
  /// What a user is told: the page's address, token and all, for this machine and for others, where
  /// `user` reaches this one as `machine`; several lines.
  std::string greeting(std::string_view user, std::string_view machine) const;

  /// Serves until stop().
  void run();
  /// Says goodbye to the clients and makes run() return. From any thread.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace motes::server
