// Serves the comparison with other implementations of the formats (interop_test.sh).
//   bag_interop files FOLDER            the walk through the room as files of scans and IMU samples
//   bag_interop replay RECORDING RUN    replays; prints the trajectory
//   bag_interop seeds FOLDER            small bags, with which tests/fuzz begins
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core_stack/common/error.h"
#include "plugins/replay/recording_source.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "sdk/replay/replay_run.h"
#include "tests/unit/replay/bag/room_bag.h"

namespace {

/// A few IMU samples and a small cloud.
void write_seeds(const std::filesystem::path& folder) {
  using namespace karst;
  using test::Serializer;
  const auto content = [](Serializer::Kind kind) {
    test::Written w = test::written(kind);
    w.messages.resize(6);
    std::string points;
    for (int i = 0; i < 5; ++i) points += std::string(18, static_cast<char>(i));
    w.messages.push_back(
        {0, w.messages.back().time + 1,
         test::point_cloud2(kind, w.messages.back().time, "os_sensor", test::kOusterFields, 18, points)});
    return w;
  };
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  const test::Written one = content(Serializer::ros1), two = content(Serializer::cdr_little);
  using enum replay::Compression;
  for (const auto c : {none, bz2, lz4})
    for (const bool index : {true, false})
      write(std::string("rosbag/") + core::name_of(c) + (index ? ".bag" : "_unindexed.bag"),
            test::ros1_bag(one.topics, one.messages, {c, index, 4}));
  for (const auto c : {none, zstd, lz4})
    for (const bool index : {true, false})
      write(std::string("mcap/") + core::name_of(c) + (index ? ".mcap" : "_without_summary.mcap"),
            test::mcap_file(two.topics, two.messages, {c, index, 4}));
  write("mcap/loose.mcap", test::mcap_file(two.topics, two.messages, {none, true, 0}));
  std::filesystem::create_directories(folder / "db3");
  std::filesystem::remove(folder / "db3/indexed.db3");
  test::write_db3((folder / "db3/indexed.db3").string(), two.topics, two.messages, true);
}

}  // namespace

int main(int argc, char** argv) try {
  using namespace karst;
  if (argc == 3 && std::strcmp(argv[1], "files") == 0) {
    test::write_room_files(argv[2]);
    return 0;
  }
  if (argc == 3 && std::strcmp(argv[1], "seeds") == 0) {
    write_seeds(argv[2]);
    return 0;
  }
  if (argc == 4 && std::strcmp(argv[1], "replay") == 0) {
    const replay::RecordingSource source = replay::open_source(argv[2], "");
    replay::replay_recording(*source.sensors, {}, argv[3],
                             [](auto, const auto&, const auto&) { return true; });
    for (const std::string& d : source.sensors->damage().first) std::fprintf(stderr, "%s\n", d.c_str());
    std::fputs(replay::file_bytes((std::filesystem::path(argv[3]) / "trajectory.tum").string()).c_str(),
               stdout);
    return source.sensors->damage().count > 0;
  }
  std::fprintf(stderr, "bag_interop files FOLDER | replay RECORDING RUN | seeds FOLDER\n");
  return 2;
} catch (const karst::core::InputError& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
