// The server as its clients meet it.
#include "server/server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/files.h"
#include "server/running_server.h"
#include "server/studio.h"

namespace motes::server {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::size_t count_entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Server, GivesNothingWithoutTheToken) {
  const RunningServer server;
  for (const std::string target : {"/", "/socket", "/picture?client=1&width=9&height=9&format=png",
                                   "/nowhere", "/?token=", "/?token=x", "/?Token=abc"}) {
    EXPECT_EQ(request(server, http::verb::get, target).status, 403) << target;
  }
  EXPECT_EQ(request(server, http::verb::post, "/upload?name=a.xyz", "1\n").status, 403);
  EXPECT_THROW(Client(server.port(), "wrong"), boost::system::system_error);
}

TEST(Server, KnowsItsNamesAndItsOwnPages) {
  const RunningServer server;
  const std::string page = "/?token=" + server.token();
  EXPECT_EQ(request(server, http::verb::get, page).status, 200);
  EXPECT_EQ(request(server, http::verb::get, page, "", "evil.com").status, 403);
  EXPECT_EQ(request(server, http::verb::get, page, "", "127.0.0.1", "http://evil.com").status, 403);
}

TEST(Server, TellsHowToReachIt) {
  const auto told = [](const std::string& address) {
    Studio studio;
    Files files("/", 0);
    ServerOptions options;
    options.address = address;
    options.token = "abcdefghijklmnop";
    const Server server(options, studio, files);
    const std::string port = std::to_string(server.port());
    std::string text = server.greeting("me", "node");
    for (auto at = text.find(port); at != text.npos; at = text.find(port)) {
      text.replace(at, port.size(), "PORT");
    }
    return text;
  };
  for (const std::string address : {"127.0.0.1", "localhost"}) {
    const std::string text = told(address);
    EXPECT_THAT(text, HasSubstr("http://127.0.0.1:PORT/?token=abcdefghijklmnop\n"));
    EXPECT_THAT(text, HasSubstr("ssh -N -L PORT:127.0.0.1:PORT me@node\n"));
    EXPECT_THAT(text, testing::Not(HasSubstr("network")));
  }
  const std::string open = told("0.0.0.0");
  EXPECT_THAT(open, HasSubstr("http://localhost:PORT/?token=abcdefghijklmnop\n"));
  EXPECT_THAT(open, HasSubstr("http://node:PORT/?token=abcdefghijklmnop\n"));
  EXPECT_THAT(open, HasSubstr("ssh -N -L PORT:127.0.0.1:PORT me@node\n"));
  EXPECT_THAT(open, HasSubstr("Others in the network can reach port PORT"));
}

TEST(Server, GivesThePageUnderAStrictPolicy) {
  const RunningServer server;
  const Reply page = request(server, http::verb::get, "/?token=" + server.token());
  const std::string policy = page.headers["Content-Security-Policy"].to_string();
  EXPECT_THAT(policy, StartsWith("default-src 'none'; script-src 'nonce-"));
  EXPECT_THAT(page.body, HasSubstr("<!doctype html>"));
  EXPECT_THAT(page.body, testing::Not(HasSubstr("{{nonce}}")));
  const std::string nonce = policy.substr(policy.find("nonce-") + 6, 32);
  EXPECT_THAT(page.body, HasSubstr("nonce=\"" + nonce + "\""));
  EXPECT_EQ(page.headers["Cache-Control"], "no-store");
}

TEST(Server, StaysBelowItsBaseUrl) {
  ServerOptions options;
  options.base_url = "/motes/";
  const RunningServer server(options);
  EXPECT_EQ(request(server, http::verb::get, "/motes/?token=" + server.token()).status, 200);
  EXPECT_EQ(request(server, http::verb::get, "/?token=" + server.token()).status, 404);
}

TEST(Server, ShowsTheSceneAndThenTheFullPicture) {
  const RunningServer server;
  TestClient client(server);
  EXPECT_EQ(client.wait_for("hello").at("protocol"), 1);
  const auto scene = client.wait_for("scene");
  EXPECT_EQ(scene.at("data").at("particles"), 3);
  client.set_size(64, 48);
  client.look(5, 1, false);
  ReceivedFrame frame;
  do frame = client.wait_for_final();
  while (frame.header.view_sequence != 5);
  EXPECT_EQ(frame.header.width, 64U);
  EXPECT_EQ(frame.header.height, 48U);
  // The picture that is saved is the one that is seen.
  const Reply picture =
      request(server, http::verb::get,
              "/picture?client=1&width=64&height=48&format=png&token=" + server.token());
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.body, frame.image);
}

TEST(Server, GivesSlowClientsFewerFramesAndNoLateOnes) {
  const RunningServer server;
  TestClient client(server);
  client.wait_for("scene");
  client.set_size(64, 48);
  for (std::uint32_t i = 1; i <= 50; ++i) client.look(i, 1 + 0.01 * i, true);
  std::uint32_t newest = client.wait_for_frame(false).header.frame;
  client.look(51, 3, false);
  // No more than another one comes until one is acknowledged, and answers do not wait for that.
  int frames = 1;
  for (int answer = 0; answer < 20; ++answer) {
    client.send(R"({"type":"statistics"})");
    while (true) {
      const std::string message = client.read().value();
      if (const auto frame = parse_frame_header(message)) {
        ++frames;
        newest = frame->frame;
      } else if (message.find("\"statistics\"") != message.npos) {
        break;
      }
    }
  }
  EXPECT_LE(frames, 2);
  client.acknowledge(newest);
  EXPECT_EQ(client.wait_for_frame().header.view_sequence, 51U);
}

TEST(Server, ClosesTheClientThatSaysNonsenseAndNoOther) {
  const RunningServer server;
  TestClient good(server), bad(server), large(server);
  good.wait_for("scene");
  bad.send("nonsense");
  EXPECT_EQ(bad.wait_for_close(), 4000);
  large.send(std::string(max_message_bytes + 1, ' '));
  large.wait_for_close();
  good.send(R"({"type":"statistics"})");
  good.wait_for("statistics");
}

TEST(Server, ClosesTheClientThatSaysTooMuch) {
  const RunningServer server;
  TestClient client(server);
  for (int i = 0; i < 2000; ++i) client.send(R"({"type":"ack","frame":0})");
  EXPECT_EQ(client.wait_for_close(), 4000);
}

TEST(Server, TakesSoManyClientsAndNoMore) {
  ServerOptions options;
  options.max_clients = 2;
  const RunningServer server(options);
  TestClient first(server), second(server), third(server);
  EXPECT_EQ(third.wait_for_close(), 4001);
  first.wait_for("hello");
}

TEST(Server, OpensFilesOfItsFolderAlone) {
  const RunningServer server;
  TestClient client(server);
  client.wait_for("scene");
  client.send(R"({"type":"list","path":""})");
  EXPECT_EQ(client.wait_for("listing").at("entries").size(), 2U);
  for (const std::string path : {"../x.xyz", "/etc/passwd", "nowhere.xyz"}) {
    client.send(nlohmann::json{{"type", "open"}, {"path", path}}.dump());
    EXPECT_THAT(client.wait_for("error").at("message"), HasSubstr("there is no such file"));
  }
  EXPECT_EQ(client.open("other.xyz").at("data").at("particles"), 2);
}

TEST(Server, AnswersACancelWhateverIsUnderWay) {
  const RunningServer server;
  TestClient client(server);
  client.wait_for("scene");
  client.send(R"({"type":"open","path":"other.xyz"})");
  client.send(R"({"type":"cancel"})");
  client.wait_for("ready");
  client.send(R"({"type":"statistics"})");
  client.wait_for("statistics");
}

TEST(Server, TakesUploadsUpToItsLimit) {
  ServerOptions options;
  options.max_upload_bytes = 1000;
  const RunningServer server(options);
  const std::string upload = "/upload?name=sent.xyz&token=" + server.token();
  EXPECT_EQ(request(server, http::verb::post, upload, std::string(1001, 'x')).status, 413);
  const Reply reply = request(server, http::verb::post, upload, "1\n\nC 0 0 0\n");
  ASSERT_EQ(reply.status, 200);
  TestClient client(server);
  const auto path = nlohmann::json::parse(reply.body).at("path");
  EXPECT_EQ(client.open(path).at("data").at("particles"), 1);
}

TEST(Server, KeepsNoUploadThatItCannotOpenAndNotMoreThanItsLimit) {
  ServerOptions options;
  options.max_kept_bytes = 100;
  const RunningServer server(options);
  const std::string upload = "/upload?name=sent.xyz&token=" + server.token();
  EXPECT_EQ(request(server, http::verb::post, upload, std::string(101, 'x')).status, 507);
  TestClient client(server);
  const auto open = [&](const std::string& body) -> std::filesystem::path {
    const std::string path =
        nlohmann::json::parse(request(server, http::verb::post, upload, body).body).at("path");
    client.send(nlohmann::json{{"type", "open"}, {"path", path}}.dump());
    return path;
  };
  const auto bad = open("no particles");
  client.wait_for("error");
  EXPECT_FALSE(std::filesystem::exists(bad));
  const auto good = open("1\n\nC 0 0 0\n");
  while (client.wait_for("scene").at("data").at("particles") != 1) {
  }
  // It is shown: no other takes its place.
  EXPECT_EQ(request(server, http::verb::post, upload, std::string(99, 'x')).status, 507);
  EXPECT_TRUE(std::filesystem::exists(good));
  client.send(R"({"type":"open","path":"other.xyz"})");
  while (client.wait_for("scene").at("data").at("particles") != 2) {
  }
  EXPECT_EQ(request(server, http::verb::post, upload, std::string(99, 'x')).status, 200);
  EXPECT_FALSE(std::filesystem::exists(good));
}

TEST(Server, AnswersSoManyRequestsAndStrangersKeepNobodyOut) {
  ServerOptions options;
  options.requests_per_second = 1e-3;
  options.request_burst = 2;
  const RunningServer server(options);
  const auto status = [&server](const std::string& token) {
    return request(server, http::verb::get, "/?token=" + token).status;
  };
  for (const int expected : {403, 403, 429}) EXPECT_EQ(status("wrong"), expected);
  for (const int expected : {200, 200, 429}) EXPECT_EQ(status(server.token()), expected);
}

TEST(Server, GivesColourMapsAsPoints) {
  const RunningServer server;
  TestClient client(server);
  client.wait_for("scene");
  std::ofstream(server.folder() / "nameless.csv") << "x,y,z\n0,0,0\n1,0,0\n0,1,0\n";
  const auto scene = client.open("nameless.csv");
  const auto function = scene.at("scene").at("fields").at(0).at("transfer_function");
  EXPECT_GT(function.at("points").size(), 2U) << function;
}

TEST(Server, TellsWhetherTheCameraWasFitted) {
  const RunningServer server;
  TestClient client(server);
  auto message = client.wait_for("scene");
  EXPECT_TRUE(message.at("fitted"));
  EXPECT_TRUE(TestClient(server).wait_for("scene").at("fitted"));
  // An edit brings the camera of who makes it.
  message["scene"]["render"]["background"] = {0.5, 0, 0};
  client.send(
      nlohmann::json{{"type", "scene"}, {"sequence", 1}, {"scene", message["scene"]}}.dump());
  while (message.at("sequence") != 1) message = client.wait_for("scene");
  EXPECT_FALSE(message.contains("fitted"));
  EXPECT_FALSE(TestClient(server).wait_for("scene").contains("fitted"));
}

TEST(Server, SaysWhatIsWrongWithASceneAndKeepsTheOldOne) {
  const RunningServer server;
  TestClient client(server);
  auto scene = client.wait_for("scene").at("scene");
  const auto good = scene;
  scene["fields"][0]["radius"] = -1;
  client.send(nlohmann::json{{"type", "scene"}, {"sequence", 9}, {"scene", scene}}.dump());
  const auto error = client.wait_for("error");
  EXPECT_EQ(error.at("sequence"), 9);
  EXPECT_THAT(error.at("message"), HasSubstr("fields[0].radius"));
  TestClient other(server);
  EXPECT_EQ(other.wait_for("scene").at("scene"), good);
}

TEST(Server, OutlivesThousandClientsThatComeAndGo) {
  ServerOptions options;
  options.request_burst = 2000;
  options.max_clients = 1001;  // of some it may not have heard yet that they have gone
  const RunningServer server(options);
  TestClient client(server);
  client.wait_for("scene");
  client.set_size(16, 16);
  client.look(1, 1, false);
  while (client.wait_for_final().header.view_sequence != 1) {
  }
  const std::size_t threads = count_entries("/proc/self/task");
  const std::size_t descriptors = count_entries("/proc/self/fd");
  for (int i = 0; i < 1000; ++i) {
    TestClient passing(server);
    passing.set_size(16, 16);
    if (i % 3 == 0) passing.look(1, 1, true);
    if (i % 2 == 0) passing.close();  // the others vanish
  }
  client.look(2, 2, false);
  while (client.wait_for_final().header.view_sequence != 2) {
  }
  // Those that have gone are forgotten.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  int clients = 0;
  do {
    client.send(R"({"type":"statistics"})");
    clients = client.wait_for("statistics").at("clients");
  } while ((clients != 1 || count_entries("/proc/self/fd") != descriptors) &&
           std::chrono::steady_clock::now() < deadline);
  EXPECT_EQ(clients, 1);
  EXPECT_EQ(count_entries("/proc/self/fd"), descriptors);
  EXPECT_EQ(count_entries("/proc/self/task"), threads);
}

}  // namespace
}  // namespace motes::server
