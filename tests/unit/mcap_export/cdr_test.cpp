// Messages as bytes, against bytes written by hand from the rules of CDR.
#include "sdk/mcap_export/cdr.h"

#include <gtest/gtest.h>

#include "sdk/mcap_export/ros_messages.h"

namespace karst::ros {
namespace {

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int v : values) out += static_cast<char>(v);
  return out;
}

struct Inner {
  static constexpr const char* kType = "test/Inner";
  std::uint8_t small = 0;
  std::int16_t middle = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"small", &Inner::small}, Field{"middle", &Inner::middle});
  }
};
struct Mixed {
  static constexpr const char* kType = "test/Mixed";
  bool flag = false;
  double number = 0;
  std::string text;
  std::vector<std::uint8_t> raw;
  std::vector<Inner> inner;
  std::array<float, 2> pair{};
  static constexpr auto members() {
    return std::make_tuple(Field{"flag", &Mixed::flag}, Field{"number", &Mixed::number},
                           Field{"text", &Mixed::text}, Field{"raw", &Mixed::raw},
                           Field{"inner", &Mixed::inner}, Field{"pair", &Mixed::pair});
  }
};

TEST(Cdr, AlignsEachNumberToItsSizeBehindTheHeader) {
  const Mixed message{true, 1.5, "ab", {7, 8, 9}, {{1, -2}, {3, 4}}, {1.0f, -2.0f}};
  EXPECT_EQ(cdr_of(message), bytes({0, 1, 0,    0,                           // little-endian CDR
                                    1, 0, 0,    0,    0,   0,   0,    0,     // flag, 7 bytes to the next 8
                                    0, 0, 0,    0,    0,   0,   0xf8, 0x3f,  // 1.5
                                    3, 0, 0,    0,    'a', 'b', 0,           // text with its zero
                                    0,                                       // to the next 4
                                    3, 0, 0,    0,    7,   8,   9,           // bytes
                                    0, 2, 0,    0,    0,                     // two of Inner
                                    1, 0, 0xfe, 0xff, 3,   0,   4,    0,  // each: a byte, one to the next 2
                                    0, 0, 0x80, 0x3f, 0,   0,   0,    0xc0}));  // an array has no length
}

TEST(Cdr, EmptySequencesAndTextsAreTheirLengthAlone) {
  EXPECT_EQ(cdr_of(Mixed{}), bytes({0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                                    1, 0, 0, 0, 0, 0, 0, 0,                                      // ""
                                    0, 0, 0, 0, 0, 0, 0, 0,                                      // raw, inner
                                    0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Cdr, AHeaderIsItsStampAndItsFrame) {
  const Header header{{5, 250'000'000}, "map"};
  EXPECT_EQ(cdr_of(header),
            bytes({0, 1, 0, 0, 5, 0, 0, 0, 0x80, 0xb2, 0xe6, 0x0e, 4, 0, 0, 0, 'm', 'a', 'p', 0}));
}

TEST(Cdr, MessagesBehindOtherBytesAreAlignedToTheirOwnBegin) {
  Mixed message;
  message.number = 2;
  std::string out = "x";
  CdrWriter(out).put(message);
  EXPECT_EQ(out.substr(1), cdr_of(message));
}

}  // namespace
}  // namespace karst::ros
