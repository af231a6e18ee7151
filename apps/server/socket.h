// A page's WebSocket: messages in, answers and frames out.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "server/asio.h"
#include "server/messages.h"
#include "server/options.h"
#include "server/outlet.h"
#include "server/rate_limit.h"

namespace motes::server {

/// Calls something if it is not stopped in time.
class Deadline {
 public:
  Deadline(const asio::any_io_executor& executor, std::chrono::milliseconds time)
      : timer_(executor), time_(time) {}

  /// From now on, whatever was before. `missed` holds what it needs.
  template <class Missed>
  void start(Missed missed) {
    timer_.expires_after(time_);
    timer_.async_wait([missed = std::move(missed)](const boost::system::error_code& stopped) {
      if (!stopped) missed();
    });
  }
  void stop() { timer_.cancel(); }

 private:
  asio::steady_timer timer_;
  const std::chrono::milliseconds time_;
};

class Socket : public Outlet, public std::enable_shared_from_this<Socket> {
 public:
  using Stream = websocket::stream<beast::tcp_stream>;
  using Request = http::request<http::empty_body>;

  /// What is done with a client's messages, on the network's thread. What it throws of Error is a
  /// malformed message.
  class Receiver {
   public:
    virtual ~Receiver() = default;
    virtual void receive(Socket& from, const Message& message) = 0;
  };

  Socket(beast::tcp_stream stream, ClientId id, const Timeouts& timeouts);

  ClientId id() const { return id_; }
  /// Accepts the upgrade and hands messages to `receiver` until either side closes.
  asio::awaitable<void> run(const Request& request, Receiver& receiver);
  /// Tells the client why and closes. On the network's thread.
  void close(websocket::close_code code, std::string_view reason);

  void send_text(std::string text) override;
  void send_frame(std::string message) override;
  void recall_frame(std::uint32_t frame) override;

 private:
  asio::awaitable<void> read_all(Receiver& receiver);
  asio::awaitable<void> write_all();
  asio::awaitable<void> write_text(std::string text, boost::system::error_code& error);
  asio::awaitable<void> write_frame(std::string frame, boost::system::error_code& error);
  void acknowledged(std::uint32_t frame);
  /// For Deadline: cut().
  auto too_late() {
    return [self = shared_from_this()] { self->cut(); };
  }
  void wake();
  /// Ends the connection at once, without a word.
  void cut();

  Stream stream_;
  const ClientId id_;
  RateLimit rate_;
  // What has not left yet; all on the network's thread.
  std::deque<std::string> texts_;
  std::size_t text_bytes_ = 0;
  std::optional<std::string> frame_;
  std::uint32_t recalled_ = 0;  ///< up to which frames are of no use any more
  std::optional<websocket::close_reason> close_reason_;
  asio::steady_timer something_to_write_;
  bool ended_ = false;
  // What the client owes.
  Deadline taking_, acknowledgement_;
  std::uint32_t newest_frame_ = 0, acknowledged_ = 0;
};

/// Application's own close codes.
inline constexpr auto close_malformed = static_cast<websocket::close_code>(4000);
inline constexpr auto close_too_many = static_cast<websocket::close_code>(4001);

}  // namespace motes::server
