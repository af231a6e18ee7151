// Who is let in.
#include "server/access.h"

#include <gtest/gtest.h>

#include "server/target.h"

namespace motes::server {
namespace {

TEST(Token, IsLongAndNeverTheSame) {
  const std::string token = make_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, make_token());
}

TEST(Token, IsComparedWhole) {
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "xbc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "ab"));
  EXPECT_FALSE(equal_in_constant_time("", "a"));
}

TEST(HostName, IsTakenFromAuthorities) {
  EXPECT_EQ(host_name("localhost:8080"), "localhost");
  EXPECT_EQ(host_name("LocalHost"), "localhost");
  EXPECT_EQ(host_name("[::1]:80"), "::1");
  EXPECT_EQ(host_name("a:b"), "");
  EXPECT_EQ(host_name("user@evil:80x"), "");
}

TEST(HostNames, AreThoseOfTheMachineAlone) {
  const HostNames names("127.0.0.1", {});
  EXPECT_TRUE(names.accept("127.0.0.1:1234", ""));
  EXPECT_TRUE(names.accept("localhost:1234", "http://localhost:1234"));
  EXPECT_TRUE(names.accept("[::1]:1234", "http://[::1]:1234"));
  EXPECT_FALSE(names.accept("", ""));
  EXPECT_FALSE(names.accept("evil.com", ""));
  EXPECT_FALSE(names.accept("evil.com:1234", "http://evil.com:1234"));
  EXPECT_FALSE(names.accept("127.0.0.1.evil.com:1234", ""));
  // Another server of this machine is another origin.
  EXPECT_FALSE(names.accept("localhost:1234", "http://localhost:4321"));
  EXPECT_FALSE(names.accept("localhost:1234", "http://evil.com"));
  EXPECT_FALSE(names.accept("localhost:1234", "null"));
}

TEST(HostNames, ThatTheUserAddsAreProxies) {
  const HostNames names("127.0.0.1", {"Portal.Example.org"});
  EXPECT_TRUE(names.accept("portal.example.org", "https://portal.example.org"));
  EXPECT_TRUE(names.accept("127.0.0.1:1234", "https://portal.example.org"));
  EXPECT_FALSE(names.accept("127.0.0.1:1234", "https://example.org"));
}

TEST(Target, IsDecoded) {
  const auto target = parse_target("/a%20b?token=x%26y&name=%2e%2e%2F&empty=&flag");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/a b");
  EXPECT_EQ(target->parameter("token"), "x&y");
  EXPECT_EQ(target->parameter("name"), "../");
  EXPECT_EQ(target->parameter("flag"), "");
  EXPECT_EQ(target->parameter("absent"), "");
}

TEST(Target, MayBeNone) {
  for (const char* text : {"", "a", "*", "http://host/", "/%", "/%1", "/%zz", "/?a=%g0"}) {
    EXPECT_FALSE(parse_target(text)) << text;
  }
}

TEST(Number, IsAllOfTheText) {
  EXPECT_EQ(parse_number("12", 1, 100), 12);
  for (const char* text : {"", "0", "101", "1x", " 1", "-1", "99999999999999"}) {
    EXPECT_FALSE(parse_number(text, 1, 100)) << text;
  }
}

}  // namespace
}  // namespace motes::server
