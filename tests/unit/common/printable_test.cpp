#include "core_stack/common/printable.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

TEST(Printable, TextStaysAsItIs) {
  const std::string text = "gr\xc3\xbcn \xe6\xb4\x9e\xe7\xaa\x9f \xf0\x9f\xa6\x87 \xc2\xa0 a\tb\nc";
  EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, ControlCharactersAreReplaced) {
  EXPECT_EQ(printable("a\033]0;owned\007b\033[2J\r\b\177"), "a?]0;owned?b?[2J???");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "?2J")
      << "U+009B, CSI in one character";
  EXPECT_EQ(printable("\x9b"
                      "2J"),
            "?2J")
      << "the same in Latin-1";
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
}

TEST(Printable, DirectionsAreReplaced) {
  EXPECT_EQ(printable("safe\xe2\x80\xaegnp.exe"), "safe?gnp.exe") << "U+202E";
  EXPECT_EQ(printable("\xe2\x81\xa6\xe2\x81\xa9\xd8\x9c\xe2\x80\x8f"), "????");
}

TEST(Printable, WhatIsNoUtf8IsReplacedByteByByte) {
  EXPECT_EQ(printable("\xc0\xaf|\xe0\x80\xaf|\xed\xa0\x80|\xf4\x90\x80\x80|\xe2\x82"), "??|???|???|????|??");
}

}  // namespace
}  // namespace karst::core
