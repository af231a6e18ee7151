// A server with something to look at, and clients of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "document/input.h"
#include "server/asio.h"
#include "server/background_server.h"
#include "server/client.h"

namespace motes::server {

/// A few atoms in a folder of their own, served until the end of the test.
class RunningServer {
 public:
  explicit RunningServer(const ServerOptions& options = {}) : folder_(make_folder()) {
    Scene scene = open_scene(folder_ / "atoms.xyz");
    server_.emplace(options, folder_, Opening{"atoms.xyz", [scene] { return scene; }});
  }
  ~RunningServer() {
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
  std::optional<BackgroundServer> server_;
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

/// A page that looks at the atoms.
class TestClient : public Client {
 public:
  explicit TestClient(const RunningServer& server, std::optional<int> receive_buffer = {})
      : Client(server.port(), server.token(), receive_buffer) {}

  /// From the side by `x`.
  void look(std::uint32_t sequence, double x, bool moving) {
    Client::look(sequence,
                 {{"eye", {x, 0.3, 12}}, {"target", {0.3, 0.3, 0}}, {"up", {0, 1, 0}}, {"fov", 30}},
                 moving);
  }
  /// Asks for a file of that path or name, and waits until its scene is shown.
  nlohmann::json open(const std::string& path) {
    send(nlohmann::json{{"type", "open"}, {"path", path}}.dump());
    const auto name = std::filesystem::path(path).filename().string();
    auto scene = wait_for("scene");
    while (scene.at("data").at("file") != name) scene = wait_for("scene");
    return scene;
  }
};

}  // namespace motes::server
