// Messages of pages: good ones, and every way to be none.
#include "server/messages.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "core/error.h"

namespace motes::server {
namespace {

constexpr const char* camera = R"({"eye":[0,0,-80],"target":[0,0,0],"up":[0,1,0],"fov":45})";

TEST(Messages, AreRead) {
  const Message view = parse_message(R"({"type":"view","sequence":7,"moving":true,"camera":)" +
                                     std::string(camera) + "}");
  EXPECT_EQ(std::get<ViewMessage>(view).sequence, 7U);
  EXPECT_TRUE(std::get<ViewMessage>(view).moving);
  EXPECT_EQ(std::get<ViewMessage>(view).camera,
            (Camera{{0, 0, -80}, {0, 0, 0}, {0, 1, 0}, 45, {}}));

  const Message size = parse_message(R"({"type":"size","width":640,"height":480})");
  EXPECT_EQ(std::get<SizeMessage>(size).width, 640);
  EXPECT_EQ(std::get<SizeMessage>(size).height, 480);

  const Message scene = parse_message(R"({"type":"scene","sequence":1,"scene":{"version":1}})");
  EXPECT_EQ(std::get<SceneMessage>(scene).scene, R"({"version":1})");

  EXPECT_FALSE(std::get<FollowMessage>(parse_message(R"({"type":"follow","client":null})")).client);
  EXPECT_EQ(std::get<FollowMessage>(parse_message(R"({"type":"follow","client":3})")).client, 3U);
  EXPECT_EQ(std::get<ListMessage>(parse_message(R"({"type":"list","path":""})")).path, "");
  EXPECT_TRUE(std::holds_alternative<FitMessage>(parse_message(R"({"type":"fit"})")));
}

class BadMessage : public testing::TestWithParam<const char*> {};

TEST_P(BadMessage, IsRefused) { EXPECT_THROW(parse_message(GetParam()), Error); }

INSTANTIATE_TEST_SUITE_P(
    Messages, BadMessage,
    testing::Values(
        "", "[]", "1", "{", "null", "{}", R"({"type":"nothing"})", R"({"type":7})",
        R"({"type":"fit","more":1})", R"({"type":"ack"})", R"({"type":"ack","frame":-1})",
        R"({"type":"ack","frame":4294967296})", R"({"type":"ack","frame":1.5})",
        R"({"type":"size","width":0,"height":1})", R"({"type":"size","width":100000,"height":1})",
        R"({"type":"pick","sequence":1,"x":"a","y":0})", R"({"type":"open","path":7})",
        R"({"type":"scene","sequence":1,"scene":"text"})",
        R"({"type":"view","sequence":1,"moving":1,"camera":{}})",
        R"({"type":"view","sequence":1,"moving":true,"camera":{"eye":[0,0,0],"target":[0,0,0],"up":[0,1,0]}})",
        R"({"type":"view","sequence":1,"moving":true,"camera":{"eye":[0,0,1],"target":[0,0,0],"up":[0,0,1]}})",
        R"({"type":"view","sequence":1,"moving":true,"camera":{"eye":[0,0,1],"target":[0,0,0],"up":[0,1,0],"fov":180}})",
        R"({"type":"fit","type":"ack"})"));

TEST(Messages, OfTooDeepNestingAreRefused) {
  EXPECT_THROW(parse_message(std::string(100000, '[')), Error);
}

TEST(Messages, OfTooLongPathsAreRefused) {
  EXPECT_THROW(parse_message(R"({"type":"open","path":")" + std::string(5000, 'a') + "\"}"), Error);
}

}  // namespace
}  // namespace motes::server
