// Where a flight is served, and the token of a request.
#include "sdk/live/access.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"

namespace karst::live {
namespace {

std::string read(const std::string& text) { return text_of(endpoint_of(text, "--live")); }

TEST(Endpoint, LacksWhatIsNotSaid) {
  EXPECT_EQ(read(""), "127.0.0.1:8765");
  EXPECT_EQ(read(":9000"), "127.0.0.1:9000");
  EXPECT_EQ(read("10.0.0.2"), "10.0.0.2:8765");
  EXPECT_EQ(read("0.0.0.0:1"), "0.0.0.0:1");
  EXPECT_EQ(read("[::1]:0"), "[::1]:0");
  EXPECT_EQ(read("[fe80::1]"), "[fe80::1]:8765");
}

TEST(Endpoint, WhatIsNoneIsRefusedByName) {
  for (const char* bad : {"localhost", "1.2.3", "1.2.3.4:", "1.2.3.4:65536", "1.2.3.4:-1", "1.2.3.4:80x",
                          "[::1", "[]:1", "[::1]8", "::1", "1.2.3.4:80:80", "999.1.1.1:5"}) {
    try {
      endpoint_of(bad, "--live");
      ADD_FAILURE() << bad;
    } catch (const core::InputError& e) {
      EXPECT_NE(std::string(e.what()).find(std::string("--live=") + bad), std::string::npos) << e.what();
    }
  }
}

TEST(Endpoint, TheLoopbackIsThisMachineAlone) {
  for (const char* own : {"127.0.0.1", "127.8.9.1", "[::1]"})
    EXPECT_TRUE(is_loopback(endpoint_of(own, ""))) << own;
  for (const char* others : {"0.0.0.0", "192.168.1.1", "[::]", "[fe80::1]"})
    EXPECT_FALSE(is_loopback(endpoint_of(others, ""))) << others;
}

TEST(Token, IsOfTheQueryOrTheHeader) {
  EXPECT_EQ(token_of("/?token=abcdefgh", ""), "abcdefgh");
  EXPECT_EQ(token_of("/?a=1&token=abcdefgh&b=2", ""), "abcdefgh");
  EXPECT_EQ(token_of("/", "Bearer abcdefgh"), "abcdefgh");
  EXPECT_EQ(token_of("/?token=of_query", "Bearer of_header"), "of_query");
  for (const char* none : {"/", "/?", "/?token", "/?tokens=abc", "/?a=token=abc", "/token=abc", "/?&&"})
    EXPECT_EQ(token_of(none, "Basic abcdefgh"), "") << none;
}

TEST(Token, IsTheSameOnlyIfAllOfItIs) {
  EXPECT_TRUE(same_token("abcdefgh", "abcdefgh"));
  for (const char* other : {"", "abcdefg", "abcdefghi", "abcdefgH", "Xbcdefgh"})
    EXPECT_FALSE(same_token(other, "abcdefgh")) << other;
}

TEST(Token, IsWhatAUrlHoldsAsItIs) {
  EXPECT_TRUE(is_token("Az09-._~"));
  for (const char* bad : {"", "short", "with space", "with%20escape", "with&and", "umläut-token"})
    EXPECT_FALSE(is_token(bad)) << bad;
}

TEST(LiveAccess, PagesOfOtherSitesAreNotFromHere) {
  EXPECT_TRUE(is_from_here("127.0.0.1:8765", ""));
  EXPECT_TRUE(is_from_here("localhost:8765", "http://localhost:8765"));
  EXPECT_TRUE(is_from_here("[::1]:8765", "http://[::1]:8765"));
  EXPECT_TRUE(is_from_here("[::1]", "http://[::1]"));
  EXPECT_FALSE(is_from_here("[::1", ""));
  EXPECT_TRUE(is_from_here("127.0.0.1:8765", "https://app.foxglove.dev"));
  EXPECT_TRUE(is_from_here("127.0.0.1:8765", "app://desktop"));
  EXPECT_FALSE(is_from_here("127.0.0.1:8765", "https://evil.example"));
  EXPECT_FALSE(is_from_here("127.0.0.1:8765", "https://127.0.0.1.evil.example"));
  EXPECT_FALSE(is_from_here("evil.example:8765", "")) << "a name that was made to point here";
  EXPECT_FALSE(is_from_here("127.0.0.1.evil.example:8765", ""));
  EXPECT_FALSE(is_from_here("127.0.0.1:8765", "null"));
  EXPECT_FALSE(is_from_here("", ""));
}

}  // namespace
}  // namespace karst::live
