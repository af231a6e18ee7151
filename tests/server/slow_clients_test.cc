// Clients that keep the server waiting.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "server/running_server.h"

namespace motes::server {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Clock = Client::Clock;

/// Far more than anything here should take.
constexpr auto very_long = 20s;

/// Of a server that soon leaves clients which do not take what they are sent.
ServerOptions impatient() {
  ServerOptions options;
  options.timeouts.taking = 300ms;
  return options;
}

/// A connection without a client that understands it.
class RawConnection {
 public:
  explicit RawConnection(const RunningServer& server) {
    const asio::ip::tcp::endpoint endpoint(asio::ip::address_v4::loopback(), server.port());
    stream_.socket().open(endpoint.protocol());
    // So that little is taken that nobody reads.
    stream_.socket().set_option(asio::socket_base::receive_buffer_size(4096));
    stream_.socket().connect(endpoint);
  }

  void send(const std::string& text) { asio::write(stream_.socket(), asio::buffer(text)); }
  /// All that comes until the server ends the connection.
  std::string hear() {
    std::string heard;
    boost::system::error_code error;
    stream_.expires_after(very_long);
    asio::async_read(stream_, asio::dynamic_buffer(heard),
                     [&](boost::system::error_code result, std::size_t) { error = result; });
    context_.run();
    EXPECT_EQ(error, asio::error::eof) << error.message();
    return heard;
  }

 private:
  asio::io_context context_;
  beast::tcp_stream stream_{context_};
};

std::string upgrade_request(const RunningServer& server) {
  return "GET /socket?token=" + server.token() +
         " HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
}

/// Whether the server closes, whatever else it says.
bool is_closed(Client& client) {
  try {
    while (client.read(Clock::now() + very_long)) {
    }
    return false;
  } catch (const boost::system::system_error&) {
    return true;
  }
}

/// Whether the client is alone in the end.
bool becomes_alone(Client& client) {
  for (const auto deadline = Clock::now() + very_long; Clock::now() < deadline;) {
    client.send(R"({"type":"statistics"})");
    if (client.wait_for("statistics").at("clients") == 1) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

TEST(SlowClients, ThatAskForNothingAreLeft) {
  ServerOptions options;
  options.timeouts.request = 200ms;
  const RunningServer server(options);
  for (const std::string text : {"", "GET / HTT", "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"}) {
    RawConnection half_open(server);
    half_open.send(text);
    EXPECT_EQ(half_open.hear(), "") << text;
  }
  // So are those that have had an answer.
  RawConnection answered(server);
  answered.send("GET / HTTP/1.1\r\nHost: evil.com\r\n\r\n");
  EXPECT_THAT(answered.hear(), HasSubstr("403"));
}

TEST(SlowClients, ThatSendHalfAFileAreLeft) {
  ServerOptions options;
  options.timeouts.upload = 200ms;
  const RunningServer server(options);
  RawConnection half(server);
  half.send("POST /upload?name=a.xyz&token=" + server.token() +
            " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 1000\r\n\r\n1\n\nC 0");
  EXPECT_EQ(half.hear(), "");
}

TEST(SlowClients, ThatAnswerNoPingAreLeft) {
  ServerOptions options;
  options.timeouts.silence = 400ms;
  const RunningServer server(options);
  RawConnection mute(server);
  mute.send(upgrade_request(server));
  const std::string heard = mute.hear();
  EXPECT_THAT(heard, HasSubstr("\"hello\""));
  EXPECT_THAT(heard, HasSubstr(std::string("\x89\0", 2)));  // the ping
}

TEST(SlowClients, ThatAnswerPingsAreKept) {
  ServerOptions options;
  options.timeouts.silence = 600ms;
  const RunningServer server(options);
  TestClient quiet(server);
  quiet.wait_for("scene");
  for (const auto end = Clock::now() + 900ms; Clock::now() < end;) quiet.read(end);
  quiet.send(R"({"type":"statistics"})");
  quiet.wait_for("statistics");
}

TEST(SlowClients, ThatAcknowledgeNothingAreLeft) {
  const RunningServer server(impatient());
  TestClient good(server), slow(server);
  slow.set_size(64, 48);
  EXPECT_TRUE(is_closed(slow));
  EXPECT_TRUE(becomes_alone(good));
}

TEST(SlowClients, ThatAcknowledgeAreKept) {
  const RunningServer server(impatient());
  TestClient client(server);
  client.wait_for("scene");
  client.set_size(64, 48);
  client.wait_for_final();
  for (const auto end = Clock::now() + 600ms; Clock::now() < end;) client.read(end);
  client.look(1, 1, false);
  while (client.wait_for_final().header.view_sequence != 1) {
  }
}

TEST(SlowClients, GetNoFullPictureThatIsOutdatedOnTheWay) {
  const RunningServer server;
  TestClient slow(server, 4096), other(server);
  other.wait_for("scene");
  other.send(R"({"type":"follow","client":1})");
  slow.set_size(1536, 1536);
  // Pictures to be saved come last: by then the full one waits for the client to read.
  const Reply saved =
      request(server, http::verb::get,
              "/picture?client=1&width=8&height=8&format=png&token=" + server.token());
  EXPECT_EQ(saved.status, 200);
  slow.look(1, 1, false);
  other.wait_for("camera");
  other.wait_for("camera");
  bool recalled = false;
  for (bool done = false; !done;) {
    const std::string message = slow.read().value();
    const auto header = parse_frame_header(message);
    if (!header) continue;
    slow.acknowledge(header->frame);
    if (header->final && header->view_sequence == 0) {
      EXPECT_GT(header->bytes, 300'000U);  // or the system has taken it before
      EXPECT_FALSE(is_whole(*header, message));
      recalled = true;
    }
    done = header->final && header->view_sequence == 1;
    EXPECT_TRUE(!done || is_whole(*header, message));
  }
  EXPECT_TRUE(recalled);
}

TEST(SlowClients, LetFewPicturesWaitForThem) {
  const RunningServer server;
  TestClient client(server);
  client.wait_for("scene");
  const auto target = [&server](int side) {
    return fmt::format("/picture?client=1&width={0}&height={0}&format=npy&token={1}", side,
                       server.token());
  };
  const auto becomes = [&](int status) {
    const auto deadline = Clock::now() + very_long;
    while (request(server, http::verb::get, target(4)).status != status) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(20ms);
    }
    return true;
  };
  {
    std::vector<std::unique_ptr<RawConnection>> deaf;
    for (int i = 0; i < 4; ++i) {
      deaf.push_back(std::make_unique<RawConnection>(server));
      // More than the system keeps for them.
      deaf.back()->send("GET " + target(1024) + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    }
    EXPECT_TRUE(becomes(503));
  }
  EXPECT_TRUE(becomes(200));
}

TEST(SlowClients, ThatTalkAndReadNothingAreLeft) {
  const RunningServer server(impatient());
  TestClient good(server), deaf(server);
  deaf.set_size(64, 48);
  bool left = false;
  const auto deadline = Clock::now() + very_long;
  for (std::uint32_t view = 1; !left && Clock::now() < deadline; ++view) {
    try {
      deaf.look(view, 1 + 0.001 * view, true);
      std::this_thread::sleep_for(5ms);
    } catch (const boost::system::system_error&) {
      left = true;
    }
  }
  EXPECT_TRUE(left);
  EXPECT_TRUE(becomes_alone(good));
}

TEST(SlowClients, ThatDoNotTakeTextsAreLeft) {
  const RunningServer server(impatient());
  TestClient good(server);
  auto scene = good.wait_for("scene").at("scene");
  RawConnection deaf(server);
  deaf.send(upgrade_request(server));
  // More than the system keeps for it, and less than the server does.
  auto& points = scene.at("fields").at(0).at("transfer_function").at("points");
  const auto point = points.back();
  for (int i = 1; i < 8000; ++i) {
    points.push_back(point);
    points.back()["value"] = point.at("value").get<double>() + i;
  }
  for (int i = 1; i <= 6; ++i) {
    scene["render"]["background"] = {0.01 * i, 0, 0};
    good.send(nlohmann::json{{"type", "scene"}, {"sequence", i}, {"scene", scene}}.dump());
    good.wait_for("scene");
  }
  EXPECT_TRUE(becomes_alone(good));
}

}  // namespace
}  // namespace motes::server
