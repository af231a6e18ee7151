// One thread, without coroutines: whoever calls waits.
#include "server/client.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "server/asio.h"

namespace motes::server {

struct Client::State {
  /// Runs what is under way until `done`; false: not by then.
  template <class Done>
  bool run_until(Clock::time_point deadline, const Done& done) {
    while (!done()) {
      context.restart();
      if (deadline == Clock::time_point::max()) {
        context.run_one();
      } else if (context.run_one_until(deadline) == 0) {
        return false;
      }
    }
    return true;
  }

  asio::io_context context;
  websocket::stream<beast::tcp_stream> socket{context};
  beast::flat_buffer buffer;
  bool reading = false;                              ///< a read is under way, over several calls
  std::optional<boost::system::error_code> arrived;  ///< what it came to
};

Client::Client(std::uint16_t port, std::string_view token, std::optional<int> receive_buffer)
    : state_(std::make_unique<State>()) {
  auto& socket = state_->socket;
  const asio::ip::tcp::endpoint endpoint(asio::ip::address_v4::loopback(), port);
  beast::get_lowest_layer(socket).socket().open(endpoint.protocol());
  if (receive_buffer) {
    beast::get_lowest_layer(socket).socket().set_option(
        asio::socket_base::receive_buffer_size(*receive_buffer));
  }
  beast::get_lowest_layer(socket).connect(endpoint);
  beast::get_lowest_layer(socket).socket().set_option(asio::ip::tcp::no_delay(true));
  socket.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
    request.set(http::field::origin, "http://127.0.0.1");
  }));
  socket.handshake("127.0.0.1", "/socket?token=" + std::string(token));
}

Client::~Client() = default;

void Client::send(std::string_view text) {
  std::optional<boost::system::error_code> written;
  state_->socket.text(true);
  // A read may be under way, which must not meet a write that does not know of it.
  state_->socket.async_write(
      asio::buffer(text), [&](boost::system::error_code error, std::size_t) { written = error; });
  state_->run_until(Clock::time_point::max(), [&] { return written.has_value(); });
  if (*written) throw boost::system::system_error(*written);
}

void Client::set_size(int width, int height) {
  send(nlohmann::json{{"type", "size"}, {"width", width}, {"height", height}}.dump());
}

void Client::look(std::uint32_t sequence, const nlohmann::json& camera, bool moving) {
  send(nlohmann::json{
      {"type", "view"}, {"sequence", sequence}, {"moving", moving}, {"camera", camera}}
           .dump());
}

void Client::acknowledge(std::uint32_t frame) {
  send(nlohmann::json{{"type", "ack"}, {"frame", frame}}.dump());
}

std::optional<std::string> Client::read(Clock::time_point deadline) {
  State& state = *state_;
  if (!state.reading) {
    state.reading = true;
    state.socket.async_read(state.buffer, [&state](boost::system::error_code error, std::size_t) {
      state.arrived = error;
    });
  }
  if (!state.run_until(deadline, [&] { return state.arrived.has_value(); })) return {};
  state.reading = false;
  const auto error = *std::exchange(state.arrived, std::nullopt);
  if (error) throw boost::system::system_error(error);
  std::string message = beast::buffers_to_string(state.buffer.data());
  state.buffer.clear();
  return message;
}

nlohmann::json Client::wait_for(std::string_view type) {
  while (true) {
    const std::string message = read().value();
    if (const auto frame = parse_frame_header(message)) {
      acknowledge(frame->frame);
      continue;
    }
    nlohmann::json text = nlohmann::json::parse(message);
    if (text.at("type") == type) return text;
    if (text.at("type") == "error") throw Error(text.at("message").get<std::string>());
  }
}

ReceivedFrame Client::wait_for_frame(bool acknowledged) {
  while (true) {
    const std::string message = read().value();
    const auto header = parse_frame_header(message);
    if (!header) continue;
    if (acknowledged) acknowledge(header->frame);
    if (!is_whole(*header, message)) continue;
    return {*header, message.substr(frame_header_bytes)};
  }
}

ReceivedFrame Client::wait_for_final() {
  while (true) {
    ReceivedFrame frame = wait_for_frame();
    if (frame.header.final) return frame;
  }
}

int Client::wait_for_close() {
  try {
    while (true) read();
  } catch (const boost::system::system_error&) {
    return static_cast<int>(state_->socket.reason().code);
  }
}

void Client::close() {
  std::optional<boost::system::error_code> closed;
  state_->socket.async_close(websocket::close_code::normal,
                             [&](boost::system::error_code error) { closed = error; });
  state_->run_until(Clock::time_point::max(), [&] { return closed.has_value(); });
}

}  // namespace motes::server
