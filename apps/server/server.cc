// The network's thread: everything here and in the connections runs on it alone.
#include "server/server.h"

#include <fmt/format.h>

#include <chrono>

#include "core/error.h"
#include "io/companion.h"
#include "server/connection.h"
#include "server/files.h"
#include "server/studio.h"

namespace motes::server {
namespace {

using namespace std::chrono_literals;

/// Sockets, their pages' requests and strangers together; beyond it connections wait.
constexpr std::size_t max_connections = 256;
/// How long clients have to take leave.
constexpr auto farewell = 500ms;

asio::ip::tcp::acceptor listen(asio::io_context& network, const ServerOptions& options) {
  try {
    const asio::ip::tcp::endpoint endpoint(listening_address(options.address), options.port);
    return {network, endpoint};
  } catch (const boost::system::system_error& error) {
    throw Error(fmt::format("{}:{}: cannot be listened on: {}", printable(options.address, 100),
                            options.port, error.code().message()));
  }
}

}  // namespace

struct Server::State {
  State(const ServerOptions& options_, Studio& studio, Files& files)
      : options(options_), site(options, studio, files), acceptor(listen(*network, options)) {}
  /// First goes who writes to sockets, then the sockets, then the coroutines, while the site that
  /// they use is still there.
  ~State() {
    site.studio.stop();
    site.sockets.clear();
  }

  asio::awaitable<void> accept_all();
  asio::awaitable<void> end();

  const ServerOptions options;
  Site site;
  std::unique_ptr<asio::io_context> network = std::make_unique<asio::io_context>(1);
  asio::ip::tcp::acceptor acceptor;
};

asio::awaitable<void> Server::State::accept_all() {
  asio::steady_timer pause(*network);
  while (acceptor.is_open()) {
    boost::system::error_code error;
    asio::ip::tcp::socket socket =
        co_await acceptor.async_accept(asio::redirect_error(asio::use_awaitable, error));
    // Out of file descriptors, or of patience: it may be better soon.
    if (error || site.num_connections >= max_connections) {
      if (!acceptor.is_open()) co_return;
      pause.expires_after(50ms);
      co_await pause.async_wait(asio::use_awaitable);
      continue;
    }
    socket.set_option(asio::ip::tcp::no_delay(true), error);
    asio::co_spawn(*network, serve_connection(beast::tcp_stream(std::move(socket)), site),
                   asio::detached);
  }
}

asio::awaitable<void> Server::State::end() {
  acceptor.close();
  for (const auto& [id, socket] : site.sockets) {
    socket->close(websocket::close_code::going_away, "the server ends");
  }
  asio::steady_timer pause(*network, farewell);
  while (!site.sockets.empty() && pause.expiry() > asio::steady_timer::clock_type::now()) {
    asio::steady_timer step(*network, 10ms);
    co_await step.async_wait(asio::use_awaitable);
  }
  network->stop();
}

Server::Server(const ServerOptions& options, Studio& studio, Files& files)
    : state_(std::make_unique<State>(options, studio, files)) {
  // Whoever opens a file sees what it says, not what it points to.
  keep_to_own_directories();
}

Server::~Server() = default;

std::uint16_t Server::port() const { return state_->acceptor.local_endpoint().port(); }

const std::string& Server::token() const { return state_->site.token; }

std::string Server::greeting(std::string_view user, std::string_view machine) const {
  const auto address = state_->acceptor.local_endpoint().address();
  const auto page_at = [this](std::string_view host) {
    return fmt::format("http://{}:{}{}?token={}", host, port(), state_->options.base_url, token());
  };
  const std::string own = address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
  const bool everywhere = address.is_unspecified();
  const std::string tunnel =
      fmt::format("ssh -N -L {0}:{1}:{0} {2}{3}{4}", port(), everywhere ? "127.0.0.1" : own, user,
                  user.empty() ? "" : "@", machine);
  const std::string here = page_at(everywhere ? "localhost" : own);
  if (address.is_loopback()) {
    return fmt::format(
        "Open in a browser:      {}\n"
        "From another machine:   {}\n"
        "                        and then the same address there\n",
        here, tunnel);
  }
  return fmt::format(
      "Open in a browser:      {}\n"
      "From another machine:   {}\n"
      "or, encrypted:          {}\n"
      "                        and then {} there\n"
      "Others in the network can reach port {}: the token keeps them out, but it and all else\n"
      "travel unencrypted, so that who can listen in the network can learn it.\n",
      here, everywhere ? page_at(machine) : here, tunnel, page_at("localhost"), port());
}

void Server::run() {
  asio::co_spawn(*state_->network, state_->accept_all(), asio::detached);
  state_->network->run();
}

void Server::stop() {
  asio::post(*state_->network, [state = state_.get()] {
    asio::co_spawn(*state->network, state->end(), asio::detached);
  });
}

}  // namespace motes::server
