#include "core_stack/common/input_file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

class InputFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// What all three functions say of a file; an alarm ends the test that would wait for ever.
  static std::string error_of(const std::string& file) {
    alarm(20);
    std::string said;
    const auto note = [&](auto read) {
      try {
        read();
        said += "[accepted]";
      } catch (const InputError& e) {
        if (said.empty()) said = e.what();
        EXPECT_EQ(said, e.what());
      }
    };
    note([&] { check_input(file, 100); });
    note([&] { open_input(file, 100); });
    note([&] { read_input(file, 100); });
    alarm(0);
    return said;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("karst_input_" + std::to_string(getpid()));
};

TEST_F(InputFile, GivesAllBytes) {
  const std::string bytes("a\0b\r\n\xff", 6);
  std::ofstream(path("x"), std::ios::binary) << bytes;
  EXPECT_EQ(read_input(path("x"), 6), bytes);
  std::ofstream(path("empty"), std::ios::binary);
  EXPECT_EQ(read_input(path("empty"), 6), "");
}

TEST_F(InputFile, LinksAreFollowed) {
  std::ofstream(path("x")) << "text";
  fs::create_symlink("x", path("link"));
  EXPECT_EQ(read_input(path("link"), 10), "text");
}

TEST_F(InputFile, AFifoDoesNotBlock) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  EXPECT_EQ(error_of(path("fifo")), path("fifo") + ": is a FIFO, not a regular file");
}

TEST_F(InputFile, OtherKindsAreNamed) {
  EXPECT_EQ(error_of("/dev/zero"), "/dev/zero: is a device, not a regular file");
  EXPECT_EQ(error_of(folder_.string()), folder_.string() + ": is a directory, not a regular file");
  EXPECT_EQ(error_of(path("none")), path("none") + ": cannot be opened: no such file");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path("socket").c_str(), sizeof address.sun_path - 1);
  const int socket_fd = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(socket_fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(error_of(path("socket")), path("socket") + ": is a socket, not a regular file");
  close(socket_fd);
}

// /proc/self/pagemap is a regular file of size 0, and can be read to 128 GiB.
TEST_F(InputFile, AFileOfTheKernelIsRefusedUnderAnyName) {
  fs::create_symlink("/proc/self/pagemap", path("events.jsonl"));
  for (const std::string& file : {std::string("/proc/self/pagemap"), path("events.jsonl")})
    EXPECT_EQ(error_of(file), file + ": is a file of the kernel, not a regular file");
  const std::string of_sysfs = "/sys/kernel/mm/transparent_hugepage/enabled";
  if (!fs::exists(of_sysfs)) GTEST_SKIP() << "skipped: no " << of_sysfs;
  EXPECT_EQ(error_of(of_sysfs).find(": is a file of the kernel"), of_sysfs.size());
}

TEST_F(InputFile, TheSizeIsBounded) {
  std::ofstream(path("x")) << std::string(101, 'x');
  EXPECT_EQ(error_of(path("x")), path("x") + ": is 101 bytes long; more than 100 are not read");
  fs::resize_file(path("x"), 100);
  EXPECT_EQ(error_of(path("x")), "[accepted][accepted][accepted]");
}

TEST_F(InputFile, LeavesNoDescriptorOpen) {
  std::ofstream(path("x")) << "text";
  const auto count = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); };
  const auto before = count();
  for (int i = 0; i < 10; ++i) error_of(path("x")), error_of("/dev/zero");
  EXPECT_EQ(count(), before);
}

}  // namespace
}  // namespace karst::core
