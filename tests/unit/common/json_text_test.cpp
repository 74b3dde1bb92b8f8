// JSON to text and back, whatever the text holds.
#include "core_stack/common/json_text.h"

#include <gtest/gtest.h>

#include <string>

namespace karst::core {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

TEST(JsonText, ReplacesWhatIsNoUtf8) {
  EXPECT_EQ(json_text(json{{"file", "a\xff"}}), "{\"file\":\"a\xef\xbf\xbd\"}");
  EXPECT_EQ(json_text(ordered_json{{"file", "a\xff"}}), "{\"file\":\"a\xef\xbf\xbd\"}");
}

TEST(JsonText, IndentsAndKeepsTheOrderOfOrderedJson) {
  EXPECT_EQ(json_text(ordered_json{{"b", 1}, {"a", 2}}, 1), "{\n \"b\": 1,\n \"a\": 2\n}");
  EXPECT_EQ(json_text(json{{"b", 1}, {"a", 2}}), R"({"a":2,"b":1})");
}

TEST(JsonText, WritesAsciiIfAsked) {
  const json j{{"volume", "m\xc2\xb3"}};
  EXPECT_EQ(json_text(j, -1, JsonCharacters::ascii), R"({"volume":"m\u00b3"})");
  EXPECT_EQ(json_of(json_text(j, 2, JsonCharacters::ascii)), j);
}

TEST(JsonOf, IsDiscardedForWhatIsNoJson) {
  for (const char* text : {"", "{", "{\"a\":1}x", "nul", "\xff"}) {
    EXPECT_TRUE(json_of(text).is_discarded()) << text;
    EXPECT_TRUE(json_of<ordered_json>(text).is_discarded()) << text;
  }
}

TEST(JsonOf, LeavesOutWhatLiesDeeperThanAHundredLevels) {
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_EQ(json_text(json_of(nested(50))), nested(50));
  EXPECT_LE(json_text(json_of<ordered_json>(nested(100000))).size(), 2u * 102);
}

}  // namespace
}  // namespace karst::core
