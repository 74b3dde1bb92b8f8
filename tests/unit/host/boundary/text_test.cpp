#include "sdk/host/boundary/text.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace karst::host {
namespace {

/// UTF-8 by encoding every scalar value: what `encode` makes is well formed, and nothing else is.
std::string encode(std::uint32_t c) {
  const auto byte = [](std::uint32_t v) { return static_cast<char>(v); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xC0 | c >> 6), byte(0x80 | (c & 63))};
  if (c < 0x10000) return {byte(0xE0 | c >> 12), byte(0x80 | (c >> 6 & 63)), byte(0x80 | (c & 63))};
  return {byte(0xF0 | c >> 18), byte(0x80 | (c >> 12 & 63)), byte(0x80 | (c >> 6 & 63)),
          byte(0x80 | (c & 63))};
}

TEST(Utf8, EveryScalarValueIsAcceptedAndEverySurrogateRefused) {
  for (std::uint32_t c = 0; c < 0x110000; ++c) {
    const bool surrogate = c >= 0xD800 && c < 0xE000;
    ASSERT_EQ(is_utf8(encode(c)), !surrogate) << c;
  }
  EXPECT_FALSE(is_utf8(encode(0x110000)));
}

TEST(Utf8, OverlongAndTruncatedFormsAreRefused) {
  for (const char* bad :
       {"\xC0\x80", "\xC1\xBF", "\xE0\x80\x80", "\xF0\x80\x80\x80", "\x80", "\xE2\x82", "a\xFF"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(Cleaned, IsAlwaysOneReadableLineWithinTheLimit) {
  EXPECT_TRUE(rc::check([](const std::string& bytes) {
    const std::string line = cleaned({bytes.data(), bytes.size()}, 50);
    RC_ASSERT(line.size() <= 50u);
    RC_ASSERT(fault_of({line.data(), line.size()}, 50).empty());
    if (fault_of({bytes.data(), bytes.size()}, 50).empty()) RC_ASSERT(line == bytes);
  }));
}

TEST(Cleaned, NullIsEmpty) {
  EXPECT_EQ(cleaned({nullptr, 5}, 50), "");
  EXPECT_EQ(fault_of({nullptr, 5}, 50), "has a length but no bytes");
}

TEST(ErrorText, UnterminatedAndEmptyOnesAreRead) {
  karst_error_t e{};
  e.code = 3;
  EXPECT_EQ(text_of(e), "it gave no reason (code 3)");
  std::fill(std::begin(e.text), std::end(e.text), 'x');
  EXPECT_EQ(text_of(e), std::string(256, 'x'));
  fill_error(&e, 1, std::string(1000, 'y'));
  EXPECT_EQ(text_of(e), std::string(255, 'y'));
}

}  // namespace
}  // namespace karst::host
