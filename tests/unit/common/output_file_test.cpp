#include "core_stack/common/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

class OutputFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("karst_output_" + std::to_string(getpid()));
};

TEST_F(OutputFile, ReplacesWhatWasThere) {
  open_output(path("x")) << "longer than";
  open_output(path("x")) << "text";
  EXPECT_EQ(read_input(path("x"), 100), "text");
}

TEST_F(OutputFile, AFifoThatNobodyReadsDoesNotBlock) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  alarm(20);  // instead of a test that waits for ever
  try {
    open_output(path("fifo"));
    ADD_FAILURE() << "there is no reader";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("a FIFO that nobody reads"), std::string::npos) << e.what();
  }
  alarm(0);
}

TEST_F(OutputFile, AFifoWithAReaderIsWrittenTo) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  const int reader = open(path("fifo").c_str(), O_RDONLY | O_NONBLOCK);
  open_output(path("fifo")) << "text";
  char got[8] = {};
  EXPECT_EQ(read(reader, got, sizeof got), 4);
  EXPECT_STREQ(got, "text");
  close(reader);
}

TEST_F(OutputFile, WhatCannotBeMadeIsAnError) {
  EXPECT_THROW(open_output(path("none/x")), InputError);
  EXPECT_THROW(open_output(folder_.string()), InputError);
}

}  // namespace
}  // namespace karst::core
