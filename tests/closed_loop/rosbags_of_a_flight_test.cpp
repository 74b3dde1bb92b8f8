// The sensors of a simulated flight, written as bags by ROS 1's own library (write_rosbags.cpp): each replays
// to the trajectory of the folder that the flight recorded, or to its beginning where the bag is cut.
#include <cstring>

#include "tests/closed_loop/command.h"

namespace karst {
namespace {

namespace fs = std::filesystem;

/// `bytes` without the index at their end, and with a header that knows of none: what `rosbag record` leaves
/// behind when it is killed between two chunks.
std::string unindexed(std::string bytes) {
  const std::size_t field = bytes.find("index_pos=") + std::strlen("index_pos=");
  std::uint64_t index = 0;
  std::memcpy(&index, bytes.data() + field, sizeof index);
  EXPECT_LT(index, bytes.size());
  bytes.resize(index);
  std::memset(bytes.data() + field, 0, sizeof index);
  return bytes;
}

TEST(RosbagsOfAFlight, GiveTheTrajectoryOfTheRecordedFolder) {
  const fs::path folder = fresh_folder("rosbags_of_a_flight");
  const Output flown = run_karst("fly --cave " + generated_cave("small", 7) +
                                 " --seed 7 --time 40s --set record.scans=true --set "
                                 "simulator.lidar.columns=256 --quiet --no-report --out " +
                                 (folder / "flight").string());
  ASSERT_EQ(flown.code, 0) << flown.text;
  const fs::path scans = folder / "flight" / "scans";
  const auto replayed = [&](const fs::path& recording, int code) {
    const fs::path run = folder / (recording.filename().string() + ".run");
    const Output out =
        run_karst("replay " + recording.string() + " --quiet --no-report --out " + run.string());
    EXPECT_EQ(out.code, code) << recording << '\n' << out.text;
    return bytes_of(run / "trajectory.tum");
  };
  const std::string expected = replayed(scans, 0);
  ASSERT_GT(std::count(expected.begin(), expected.end(), '\n'), 150);

  const Output bags = run_command(std::string(KARST_BINARY_DIR) + "/bin/write_rosbags " + scans.string() +
                                  " " + folder.string());
  ASSERT_EQ(bags.code, 0) << bags.text;
  const auto describe = [&](const std::string& name) {
    fs::copy_file(scans / "recording.info", folder / (name + ".info"));  // where the LiDAR is mounted
    return folder / (name + ".bag");
  };
  for (const char* name : {"none", "bz2", "lz4"}) EXPECT_EQ(replayed(describe(name), 0), expected) << name;

  const auto written = [&](const std::string& name, const std::string& bytes) {
    fs::path file = describe(name);
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  };
  EXPECT_EQ(replayed(written("unindexed", unindexed(bytes_of(folder / "lz4.bag"))), 1), expected);
  // Cut in a chunk: the same up to there.
  const auto expect_beginning = [&](const fs::path& file, double share) {
    const std::string found = replayed(file, 1);
    EXPECT_EQ(found, expected.substr(0, found.size())) << file;
    EXPECT_NEAR(static_cast<double>(found.size()), share * static_cast<double>(expected.size()),
                0.03 * static_cast<double>(expected.size()))
        << file;
  };
  expect_beginning(describe("unclosed"), 1);
  for (const char* name : {"none", "lz4"}) {
    const std::string bytes = bytes_of(folder / (std::string(name) + ".bag"));
    expect_beginning(written(std::string("cut_") + name, bytes.substr(0, bytes.size() / 2)), 0.5);
  }
  if (!HasFailure()) fs::remove_all(folder);
}

}  // namespace
}  // namespace karst
