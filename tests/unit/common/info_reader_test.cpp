// INFO text of others: no file is opened for it, and what it may cost is bounded.
#include "core_stack/common/info_reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

std::string error_of(const std::string& text) {
  try {
    parse_info(text, "ready message");
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string repeated(const std::string& text, std::size_t times) {
  std::string out;
  out.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

class InfoFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("karst_info_" + std::to_string(getpid()));
};

TEST(InfoText, IsReadAsBoostReadsIt) {
  const auto tree =
      parse_info("a 1\nb { c \"x { ; \\\" \" ; }\n }\nd \"one \" \\ ; goes on\n\n \"two\"\n", "here");
  const std::vector<std::pair<std::string, std::string>> expected{
      {"a", "1"}, {"b.c", "x { ; \" "}, {"d", "one two"}};
  EXPECT_EQ(leaves_of(tree), expected);
}

TEST(InfoText, ASyntaxErrorNamesSourceAndLine) {
  EXPECT_TRUE(error_of("a 1\n}\n").starts_with("ready message: line 2: unmatched }"));
}

// A policy's ready message that included a FIFO blocked the host in flight; /dev/zero filled its memory, and
// /etc/shadow came to lie in mission.info.
TEST_F(InfoFile, TextOfOthersIncludesNothing) {
  const std::string secret = written("secret.info", "secret 7\n");
  const std::string fifo = (folder_ / "fifo").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  for (const std::string& file : {secret, fifo, std::string("/dev/zero")})
    for (const char* before : {"", " \t", "a {\n", "a \"b\" \\\n"})
      EXPECT_TRUE(holds(error_of(before + std::string("#include \"") + file + "\"\n"),
                        "#include is followed in mission files only"))
          << before << file;
  EXPECT_TRUE(holds(error_of("a 1\n#\n"), "ready message: line 2"));
}

TEST_F(InfoFile, AFileIncludesNothingUnlessItMay) {
  written("part.info", "b 2\n");
  const std::string file = written("whole.info", "a 1\n#include \"part.info\"\n");
  EXPECT_EQ(read_including_info(file).get<int>("b"), 2);
  try {
    read_info(file);
    ADD_FAILURE() << "the part was read";
  } catch (const InputError& e) {
    EXPECT_TRUE(holds(e.what(), "whole.info: line 2: #include")) << e.what();
  }
}

TEST_F(InfoFile, WhatIsIncludedIsARegularFile) {
  ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  try {
    read_including_info(written("whole.info", "#include \"fifo\"\n"));
    ADD_FAILURE() << "a FIFO was read";
  } catch (const InputError& e) {
    EXPECT_TRUE(holds(e.what(), "fifo: is a FIFO, not a regular file")) << e.what();
  }
}

// Twenty levels of two includes each are a million files.
TEST_F(InfoFile, IncludesThatMultiplyEndAtTheBound) {
  written("0.info", repeated("; 63 bytes of remark, which are as much to read as any others...\n", 1000));
  for (int i = 1; i < 20; ++i) {
    const std::string before = "#include \"" + std::to_string(i - 1) + ".info\"\n";
    written(std::to_string(i) + ".info", before + before);
  }
  try {
    read_including_info((folder_ / "19.info").string());
    ADD_FAILURE() << "a million files were read";
  } catch (const InputError& e) {
    EXPECT_TRUE(holds(e.what(), "bytes are not read")) << e.what();
  }
}

// 200,000 levels ended the process: reading and destroying a tree recurse.
TEST(InfoText, DepthIsBounded) {
  EXPECT_TRUE(holds(error_of(repeated("a {\n", 200'000)), "line 101: blocks stand more than 100 deep"));
  EXPECT_TRUE(holds(error_of(repeated("a { ", 200)), "line 1: blocks stand more than 100 deep"));
  EXPECT_EQ(error_of(repeated("a {\n", 100) + repeated("}\n", 100)), "accepted");
}

TEST(InfoText, AMillionKeysAreRefused) {
  EXPECT_TRUE(holds(error_of(repeated("k 1\n", 1'000'000)), "line 200001: more than 400000 keys and values"));
  EXPECT_TRUE(holds(error_of(repeated("k\n", 1'000'000)), "line 400001"));
  EXPECT_EQ(error_of(repeated("k 1\n", 200'000)), "accepted");
}

TEST(InfoText, ALongValueIsRefusedHoweverItIsWritten) {
  EXPECT_TRUE(
      holds(error_of("a 1\nb " + std::string(1 << 20, 'x')), "line 2: more than 65536 bytes in a line"));
  EXPECT_TRUE(
      holds(error_of("a " + repeated("\"xxxxxxxx\" \\\n", 10'000)), "more than 65536 bytes in a line"));
  EXPECT_TRUE(
      holds(error_of("a " + repeated("\"xxxxxxxx\" \\ ; on\n;\n\n", 10'000)), "more than 65536 bytes"));
  EXPECT_TRUE(holds(error_of(std::string(17u << 20, 'x')), "ready message: is 17825792 bytes long"));
}

// A file of that size is refused before a byte of it is read.
TEST_F(InfoFile, AGigabyteIsRefused) {
  const std::string file = written("big.info", "");
  fs::resize_file(file, std::uintmax_t{1} << 30);
  try {
    read_info(file);
    ADD_FAILURE() << "a gigabyte was read";
  } catch (const InputError& e) {
    EXPECT_TRUE(holds(e.what(), "big.info: is 1073741824 bytes long")) << e.what();
  }
}

TEST(InfoText, AZeroByteIsNoText) {
  EXPECT_TRUE(holds(error_of("a 1\n" + std::string("b\0 2\n", 5)), "line 2: holds a zero byte"));
}

}  // namespace
}  // namespace karst::core
