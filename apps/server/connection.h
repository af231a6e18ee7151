// One HTTP connection.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "server/access.h"
#include "server/asio.h"
#include "server/messages.h"
#include "server/options.h"
#include "server/rate_limit.h"
#include "server/socket.h"

namespace motes::server {

class Files;
class Studio;

/// What all connections share, on the network's thread.
struct Site {
  Site(const ServerOptions& options_, Studio& studio_, Files& files_)
      : options(options_),
        token(options_.token.empty() ? make_token() : options_.token),
        hosts(listening_address(options_.address), options_.hosts),
        studio(studio_),
        files(files_),
        requests(options_.requests_per_second, options_.request_burst),
        refusals(requests) {}

  const ServerOptions& options;
  const std::string token;
  const HostNames hosts;
  Studio& studio;
  Files& files;
  std::map<ClientId, std::shared_ptr<Socket>> sockets;
  ClientId last_client = 0;
  std::size_t num_connections = 0;
  std::size_t num_uploads = 0;
  std::size_t num_pictures = 0;  ///< asked for and not sent yet
  RateLimit requests, refusals;
};

/// Answers requests until the connection ends. `site` must outlive it.
asio::awaitable<void> serve_connection(beast::tcp_stream stream, Site& site);

}  // namespace motes::server
