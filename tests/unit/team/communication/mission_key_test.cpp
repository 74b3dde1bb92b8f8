// The key of the radio: known answers of another implementation (Python's hashlib.blake2b), and key files.
#include "core_stack/team/communication/mission_key.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

MissionKey counting_key() {
  MissionKey key;
  std::iota(key.bytes.begin(), key.bytes.end(), std::uint8_t{0});
  return key;
}

TEST(MissionKey, TheTagIsTheBeginningOfKeyedBlake2b) {
  const std::string digits = "123456789";
  EXPECT_EQ(tag_of(Bytes(digits.begin(), digits.end()), counting_key()),
            (Tag{0xc8, 0xcc, 0x8b, 0xd4, 0xfe, 0xaa, 0x54, 0xd0}));
  EXPECT_EQ(tag_of({}, counting_key()), (Tag{0x3d, 0xaf, 0x97, 0xbc, 0xe7, 0x88, 0x8f, 0xd5}));
}

TEST(MissionKey, OfASeedIsTheSameOnEveryMachineAndInEveryThread) {
  const MissionKey expected{{0x48, 0xb9, 0xbd, 0x03, 0x90, 0x30, 0x2f, 0x60, 0xfc, 0x42, 0xd1,
                             0x99, 0x2d, 0x7d, 0x73, 0xdb, 0xe7, 0x70, 0xd7, 0xc6, 0x18, 0xf2,
                             0x4f, 0x8f, 0xe3, 0x92, 0x17, 0xc7, 0x4c, 0xb0, 0x43, 0xe8}};
  std::vector<MissionKey> keys(8);
  {
    std::vector<std::jthread> threads;
    for (MissionKey& key : keys) threads.emplace_back([&key] { key = key_of_seed(7); });
  }
  for (const MissionKey& key : keys) EXPECT_EQ(key.bytes, expected.bytes);
  EXPECT_NE(key_of_seed(8).bytes, expected.bytes);
}

TEST(MissionKey, ATagHoldsForItsBytesUnderItsKeyOnly) {
  const Bytes bytes = {1, 2, 3};
  const Tag tag = tag_of(bytes, counting_key());
  EXPECT_TRUE(has_tag(bytes, tag, counting_key()));
  EXPECT_FALSE(has_tag(bytes, tag, key_of_seed(1)));
  EXPECT_FALSE(has_tag(Bytes{1, 2, 4}, tag, counting_key()));
  EXPECT_FALSE(has_tag(bytes, std::span(tag).first(7), counting_key()));
}

struct KeyFile : ::testing::Test {
  std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "karst_mission.key";
  void SetUp() override { std::filesystem::remove(file); }
  void TearDown() override { std::filesystem::remove(file); }
  std::string refusal() const {
    try {
      read_key(file.string());
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(KeyFile, IsReadWithWhiteSpaceAroundItsDigits) {
  std::ofstream(file) << "000102030405060708090a0b0c0d0e0f\n101112131415161718191A1B1C1D1E1F\n";
  EXPECT_EQ(read_key(file.string()).bytes, counting_key().bytes);
}

TEST_F(KeyFile, ThatHoldsNoKeyIsRefusedByNameWithoutBeingQuoted) {
  const std::string digits = "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e";
  for (const std::string& text : {std::string(), digits, digits + "1f00", digits + "1g", digits + "1f secret",
                                  std::string(64, '0'), std::string(5000, 'a')}) {
    std::ofstream(file, std::ios::trunc) << text;
    const std::string why = refusal();
    EXPECT_NE(why.find(file.string()), std::string::npos) << why;
    EXPECT_EQ(why.find("0102"), std::string::npos) << why;
  }
}

TEST_F(KeyFile, ThatIsNoRegularFileIsRefusedWithoutBeingRead) {
  EXPECT_NE(refusal(), "") << "it is not there";
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_NE(refusal().find("not a regular file"), std::string::npos) << "a FIFO would block for ever";
}

}  // namespace
}  // namespace karst::core
