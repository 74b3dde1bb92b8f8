#include "sdk/flight/status_line.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

namespace karst::flight {
namespace {

/// A stopped terminal (Ctrl-S) is like a pipe that is full: who writes waits.
TEST(StatusLine, InRealTimeAStoppedTerminalDoesNotHoldUpTheLoop) {
  std::array<int, 2> pipe_ends;
  ASSERT_EQ(pipe2(pipe_ends.data(), O_CLOEXEC), 0);
  fcntl(pipe_ends[1], F_SETFL, O_NONBLOCK);
  const std::string filling(4096, '.');
  while (write(pipe_ends[1], filling.data(), filling.size()) > 0) {
  }
  fcntl(pipe_ends[1], F_SETFL, 0);
  const int usual = dup(STDERR_FILENO);
  dup2(pipe_ends[1], STDERR_FILENO);
  {
    StatusLine line(1, core::Clock::real_time);
    core::MissionStatus status;
    for (int i = 0; i < 5; ++i) {  // would never return
      status.time = i * 30 * core::kSecond;
      line.show(status.time, {status});
    }
    std::string read_back;
    std::array<char, 4096> buffer;
    while (read_back.find("2:00") == std::string::npos)  // the last is printed once there is room
      read_back.append(buffer.data(),
                       static_cast<std::size_t>(read(pipe_ends[0], buffer.data(), buffer.size())));
  }
  dup2(usual, STDERR_FILENO);
  for (const int d : {usual, pipe_ends[0], pipe_ends[1]}) close(d);
}

}  // namespace
}  // namespace karst::flight
