// Who is let in.
#include "server/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "server/target.h"

namespace motes::server {
namespace {

using testing::HasSubstr;

const asio::ip::address loopback = asio::ip::address_v4::loopback();

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

TEST(Token, OfTheUserIsLongAndPlain) {
  EXPECT_NO_THROW(check_token("0123456789abcde~", "X"));
  for (const char* token :
       {"", "0123456789abcde", "0123456789abcdef&", "0123456789abcdef\xc3\xa4"}) {
    try {
      check_token(token, "MOTES_VIEW_TOKEN");
      ADD_FAILURE() << token;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("MOTES_VIEW_TOKEN: expected at least 16"));
    }
  }
}

TEST(ListeningAddress, IsOneOfIpOrLocalhost) {
  EXPECT_EQ(listening_address("localhost"), loopback);
  EXPECT_EQ(listening_address("0.0.0.0"), asio::ip::address_v4::any());
  EXPECT_EQ(listening_address("[::1]"), asio::ip::address_v6::loopback());
  for (const char* text : {"", "example.org", "1.2.3", "127.0.0.1:80"}) {
    EXPECT_THROW(listening_address(text), Error) << text;
  }
}

TEST(HostName, IsTakenFromAuthorities) {
  EXPECT_EQ(host_name("localhost:8080"), "localhost");
  EXPECT_EQ(host_name("LocalHost"), "localhost");
  EXPECT_EQ(host_name("[::1]:80"), "::1");
  EXPECT_EQ(host_name("a:b"), "");
  EXPECT_EQ(host_name("user@evil:80x"), "");
}

TEST(HostNames, AreThoseOfTheMachineAlone) {
  const HostNames names(loopback, {});
  EXPECT_EQ(names.refusal("127.0.0.1:1234", ""), "");
  EXPECT_EQ(names.refusal("localhost:1234", "http://localhost:1234"), "");
  EXPECT_EQ(names.refusal("[::1]:1234", "http://[::1]:1234"), "");
  EXPECT_NE(names.refusal("", ""), "");
  EXPECT_NE(names.refusal("evil.com", ""), "");
  EXPECT_NE(names.refusal("evil.com:1234", "http://evil.com:1234"), "");
  EXPECT_NE(names.refusal("127.0.0.1.evil.com:1234", ""), "");
  // Another server of this machine is another origin.
  EXPECT_NE(names.refusal("localhost:1234", "http://localhost:4321"), "");
  EXPECT_NE(names.refusal("localhost:1234", "http://evil.com"), "");
  EXPECT_NE(names.refusal("localhost:1234", "null"), "");
}

TEST(HostNames, ThatTheUserAddsAreProxies) {
  const HostNames names(loopback, {"Portal.Example.org"});
  EXPECT_EQ(names.refusal("portal.example.org", "https://portal.example.org"), "");
  EXPECT_EQ(names.refusal("127.0.0.1:1234", "https://portal.example.org"), "");
  EXPECT_NE(names.refusal("127.0.0.1:1234", "https://example.org"), "");
}

TEST(HostNames, OfAllAddressesAreTheMachinesNameAndAddresses) {
  const HostNames names(asio::ip::address_v4::any(), {});
  EXPECT_EQ(names.refusal(machine_name() + ":1234", ""), "");
  EXPECT_EQ(names.refusal("192.168.3.4:1234", "http://192.168.3.4:1234"), "");
  EXPECT_NE(names.refusal("192.168.3.4:1234", "http://192.168.3.5:1234"), "");
  EXPECT_NE(HostNames(loopback, {}).refusal("192.168.3.4:1234", ""), "");
}

TEST(HostNames, ThatAreRefusedCanBeAdded) {
  const HostNames names(loopback, {});
  EXPECT_THAT(names.refusal("node7.cluster:1234", ""), HasSubstr("--host node7.cluster"));
  EXPECT_THAT(names.refusal("127.0.0.1:1234", "https://portal.org"),
              HasSubstr("--host portal.org"));
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
