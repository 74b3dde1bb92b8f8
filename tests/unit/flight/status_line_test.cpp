#include "sdk/flight/status_line.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

namespace karst::flight {
namespace {

std::string shown(const std::vector<core::MissionStatus>& all) {
  ::testing::internal::CaptureStderr();
  StatusLine line(1);
  for (const core::MissionStatus& s : all) line.show(s.time, {s});
  return ::testing::internal::GetCapturedStderr();
}

TEST(StatusLine, ShowsABatteryThatHasSaidNothingAsUnknown) {
  core::MissionStatus status;
  status.time = 30 * core::kSecond;
  EXPECT_EQ(shown({status}), "standby   0:30  battery unknown                  0 m³   0.0 m/s  \n");
  status.battery = core::BatteryStatus{0, 40, 0.8, 100, 605};
  EXPECT_EQ(shown({status}), "standby   0:30  battery  80 % (10:05 left)       0 m³   0.0 m/s  \n");
}

TEST(StatusLine, GivesWhatTheVehicleWaitsForALineWheneverItChanges) {
  core::MissionStatus status;
  const std::string long_reason = "waits: " + std::string(80, 'x') + "\033";
  std::vector<core::MissionStatus> all;
  for (const std::string& reason :
       {std::string("waits: not armed"), std::string("waits: not armed"), std::string(), long_reason}) {
    status.time += core::kSecond;
    status.waits_for = reason;
    all.push_back(status);
  }
  EXPECT_EQ(shown(all), "waits: not armed\nwaits: " + std::string(80, 'x') + "?\n");
}

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
