// A server with something to look at, and clients of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "document/input.h"
#include "server/asio.h"
#include "server/files.h"
#include "server/server.h"
#include "server/studio.h"

namespace motes::server {

/// A few atoms in a folder of their own, served until the end of the test.
class RunningServer {
 public:
  explicit RunningServer(ServerOptions options = {})
      : folder_(make_folder()), options_(std::move(options)), files_(folder_) {
    server_.emplace(options_, studio_, files_);
    Scene scene = open_scene(folder_ / "atoms.xyz");
    studio_.open({"atoms.xyz", [scene] { return scene; }});
    thread_ = std::thread([this] { server_->run(); });
  }
  ~RunningServer() {
    server_->stop();
    thread_.join();
    server_.reset();
    std::filesystem::remove_all(folder_);
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  std::uint16_t port() const { return server_->port(); }
  const std::string& token() const { return server_->token(); }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  static std::filesystem::path make_folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "motes-server-XXXXXX").string();
    auto folder = std::filesystem::canonical(mkdtemp(pattern.data()));
    std::ofstream(folder / "atoms.xyz") << "3\nframe 0\nO 0 0 0\nH 1 0 0\nH 0 1 0\n"
                                           "3\nframe 1\nO 0 0 1\nH 1 0 1\nH 0 1 1\n";
    std::ofstream(folder / "other.xyz") << "2\n\nC 0 0 0\nC 2 0 0\n";
    return folder;
  }

  std::filesystem::path folder_;
  const ServerOptions options_;
  Files files_;
  Studio studio_;
  std::optional<Server> server_;
  std::thread thread_;
};

/// One answer to an HTTP request.
struct Reply {
  int status = 0;
  std::string body;
  http::fields headers;
};

inline Reply request(const RunningServer& server, http::verb method, const std::string& target,
                     const std::string& body = "", const std::string& host = "127.0.0.1",
                     const std::string& origin = "") {
  asio::io_context context;
  beast::tcp_stream stream(context);
  stream.connect({asio::ip::make_address("127.0.0.1"), server.port()});
  http::request<http::string_body> request{method, target, 11, body};
  request.set(http::field::host, host);
  if (!origin.empty()) request.set(http::field::origin, origin);
  request.prepare_payload();
  http::write(stream, request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(std::uint64_t{1} << 30);
  http::read(stream, buffer, parser);
  return {static_cast<int>(parser.get().result_int()), parser.get().body(), parser.get().base()};
}

/// A page, as far as the server can tell.
class TestClient {
 public:
  explicit TestClient(const RunningServer& server, const std::string& token = "")
      : socket_(context_) {
    beast::get_lowest_layer(socket_).connect({asio::ip::make_address("127.0.0.1"), server.port()});
    socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(http::field::origin, "http://127.0.0.1");
    }));
    socket_.handshake("127.0.0.1", "/socket?token=" + (token.empty() ? server.token() : token));
  }

  void send(const std::string& text) {
    socket_.text(true);
    socket_.write(asio::buffer(text));
  }
  /// The next message; throws boost::system::system_error once the server has closed.
  std::string read() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    is_text_ = socket_.got_text();
    return beast::buffers_to_string(buffer.data());
  }
  /// The next text of a type; frames on the way are acknowledged.
  nlohmann::json wait_for(const std::string& type) {
    while (true) {
      const std::string message = read();
      if (!is_text_) {
        acknowledge(message);
        continue;
      }
      nlohmann::json text = nlohmann::json::parse(message);
      if (text.at("type") == type) return text;
    }
  }
  /// The next frame, acknowledged if that is wanted.
  std::string wait_for_frame(bool acknowledged = true) {
    while (true) {
      std::string message = read();
      if (is_text_) continue;
      if (acknowledged) acknowledge(message);
      return message;
    }
  }
  /// The next full picture.
  std::string wait_for_final() {
    while (true) {
      std::string frame = wait_for_frame();
      if (number(frame, 18, 2) == 1) return frame;
    }
  }
  /// A little-endian number of a frame's header.
  static std::uint32_t number(const std::string& frame, std::size_t at, std::size_t bytes = 4) {
    std::uint32_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) {
      value = value << 8 | static_cast<unsigned char>(frame.at(at + i));
    }
    return value;
  }
  void set_size(int width, int height) {
    send(nlohmann::json{{"type", "size"}, {"width", width}, {"height", height}}.dump());
  }
  void look(std::uint32_t sequence, double x, bool moving) {
    send(nlohmann::json{
        {"type", "view"},
        {"sequence", sequence},
        {"moving", moving},
        {"camera",
         {{"eye", {x, 0.3, 12}}, {"target", {0.3, 0.3, 0}}, {"up", {0, 1, 0}}, {"fov", 30}}}}
             .dump());
  }
  /// The code with which the server closes, after whatever it still says.
  int wait_for_close() {
    try {
      while (true) read();
    } catch (const boost::system::system_error&) {
      return static_cast<int>(socket_.reason().code);
    }
  }
  /// Goes without a word, as a killed browser does.
  void vanish() { beast::get_lowest_layer(socket_).socket().close(); }

 private:
  void acknowledge(const std::string& frame) {
    send(nlohmann::json{{"type", "ack"}, {"frame", number(frame, 4)}}.dump());
  }

  asio::io_context context_;
  websocket::stream<beast::tcp_stream> socket_;
  bool is_text_ = false;
};

}  // namespace motes::server
