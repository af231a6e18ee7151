// Two coroutines a socket: one reads, one writes what has been queued.
#include "server/socket.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <string_view>
#include <utility>
#include <variant>

#include "core/error.h"
#include "server/frame_message.h"

namespace motes::server {
namespace {

/// A mouse gives at most some hundred events a second.
constexpr double messages_per_second = 300, message_burst = 600;
/// A client that lets more than this wait is not listening.
constexpr std::size_t max_waiting_bytes = std::size_t{16} << 20;
/// Of a frame: between them it may be recalled. A slow line of 1 MB/s takes one in 66 ms.
constexpr std::size_t block_bytes = std::size_t{1} << 16;

websocket::stream_base::timeout of_stream(const Timeouts& timeouts) {
  websocket::stream_base::timeout out{};
  out.handshake_timeout = timeouts.request;
  out.idle_timeout = timeouts.silence;
  out.keep_alive_pings = true;
  return out;
}

}  // namespace

Socket::Socket(beast::tcp_stream stream, ClientId id, const Timeouts& timeouts)
    : stream_(std::move(stream)),
      id_(id),
      rate_(messages_per_second, message_burst),
      something_to_write_(stream_.get_executor(), asio::steady_timer::time_point::max()),
      taking_(stream_.get_executor(), timeouts.taking),
      acknowledgement_(stream_.get_executor(), timeouts.taking) {
  beast::get_lowest_layer(stream_).expires_never();  // the WebSocket has its own timeouts
  stream_.set_option(of_stream(timeouts));
  stream_.read_message_max(max_message_bytes);
  // What the system has taken cannot be recalled.
  const int unsent = static_cast<int>(block_bytes);
  setsockopt(beast::get_lowest_layer(stream_).socket().native_handle(), IPPROTO_TCP,
             TCP_NOTSENT_LOWAT, &unsent, sizeof unsent);
}

asio::awaitable<void> Socket::run(const Request& request, Receiver& receiver) {
  co_await stream_.async_accept(request, asio::use_awaitable);
  asio::co_spawn(
      stream_.get_executor(),
      [self = shared_from_this()]() -> asio::awaitable<void> { co_await self->write_all(); },
      asio::detached);
  co_await read_all(receiver);
  ended_ = true;
  acknowledgement_.stop();
  wake();
}

asio::awaitable<void> Socket::read_all(Receiver& receiver) {
  beast::flat_buffer buffer;
  while (true) {
    boost::system::error_code error;
    co_await stream_.async_read(buffer, asio::redirect_error(asio::use_awaitable, error));
    if (error) co_return;
    if (close_reason_) {  // what still comes is of no interest
      buffer.clear();
      continue;
    }
    try {
      if (!rate_.take(RateLimit::Clock::now())) throw Error("too many messages");
      if (!stream_.got_text()) throw Error("expected text");
      const auto data = buffer.cdata();
      const Message message = parse_message({static_cast<const char*>(data.data()), data.size()});
      if (const auto* ack = std::get_if<AckMessage>(&message)) acknowledged(ack->frame);
      receiver.receive(*this, message);
    } catch (const Error& error_of_client) {
      close(close_malformed, error_of_client.what());
    }
    buffer.clear();
  }
}

asio::awaitable<void> Socket::write_all() {
  const auto self = shared_from_this();
  while (!ended_) {
    boost::system::error_code error;
    if (!texts_.empty()) {
      std::string text = std::move(texts_.front());
      texts_.pop_front();
      text_bytes_ -= text.size();
      co_await write_text(std::move(text), error);
    } else if (close_reason_) {
      co_await stream_.async_close(*close_reason_,
                                   asio::redirect_error(asio::use_awaitable, error));
      co_return;
    } else if (frame_) {
      co_await write_frame(*std::exchange(frame_, std::nullopt), error);
    } else {
      something_to_write_.expires_at(asio::steady_timer::time_point::max());
      co_await something_to_write_.async_wait(asio::redirect_error(asio::use_awaitable, error));
      continue;  // woken by an "error"
    }
    if (error) co_return cut();
  }
}

asio::awaitable<void> Socket::write_text(std::string text, boost::system::error_code& error) {
  stream_.text(true);
  taking_.start(too_late());
  co_await stream_.async_write(asio::buffer(text),
                               asio::redirect_error(asio::use_awaitable, error));
  taking_.stop();
}

/// Only the client's word tells that a frame has arrived: the system takes much that nobody reads.
asio::awaitable<void> Socket::write_frame(std::string frame, boost::system::error_code& error) {
  stream_.binary(true);
  newest_frame_ = parse_frame_header(frame).value().frame;
  std::string_view rest = frame;
  for (bool last = false; !last && !error;) {
    if (recalled_ >= newest_frame_ && rest.size() < frame.size()) rest = {};
    const std::string_view block = rest.substr(0, block_bytes);
    rest.remove_prefix(block.size());
    last = rest.empty();
    if (newest_frame_ > acknowledged_) acknowledgement_.start(too_late());
    co_await stream_.async_write_some(last, asio::buffer(block.data(), block.size()),
                                      asio::redirect_error(asio::use_awaitable, error));
  }
}

void Socket::acknowledged(std::uint32_t frame) {
  if (frame <= acknowledged_) return;
  acknowledged_ = frame;
  acknowledgement_.stop();
  if (newest_frame_ > acknowledged_) acknowledgement_.start(too_late());
}

void Socket::close(websocket::close_code code, std::string_view reason) {
  if (close_reason_) return;
  constexpr std::size_t max_reason = 123;  // what a control frame holds
  close_reason_.emplace(code, std::string(reason.substr(0, max_reason)));
  wake();
}

void Socket::send_text(std::string text) {
  asio::post(stream_.get_executor(), [self = shared_from_this(), text = std::move(text)]() mutable {
    if (self->ended_ || self->close_reason_) return;
    self->text_bytes_ += text.size();
    if (self->text_bytes_ > max_waiting_bytes) return self->cut();
    self->texts_.push_back(std::move(text));
    self->wake();
  });
}

void Socket::send_frame(std::string message) {
  asio::post(stream_.get_executor(),
             [self = shared_from_this(), message = std::move(message)]() mutable {
               self->frame_ = std::move(message);
               self->wake();
             });
}

void Socket::recall_frame(std::uint32_t frame) {
  asio::post(stream_.get_executor(), [self = shared_from_this(), frame] {
    self->recalled_ = frame;
    if (self->frame_ && parse_frame_header(*self->frame_)->frame <= frame) self->frame_.reset();
  });
}

void Socket::wake() { something_to_write_.cancel(); }

void Socket::cut() {
  ended_ = true;
  acknowledgement_.stop();
  beast::get_lowest_layer(stream_).socket().close();
  wake();
}

}  // namespace motes::server
