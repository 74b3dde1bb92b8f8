// Serves the comparison with other implementations of the formats (interop_test.sh).
//   bag_interop files FOLDER            the walk through the room as files of scans and IMU samples
//   bag_interop replay RECORDING RUN    replays; prints the trajectory
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core_stack/common/error.h"
#include "plugins/replay/recording_source.h"
#include "plugins/replay/scan_file.h"
#include "sdk/replay/replay_run.h"
#include "tests/unit/replay/bag/room_bag.h"

int main(int argc, char** argv) try {
  using namespace karst;
  if (argc == 3 && std::strcmp(argv[1], "files") == 0) {
    test::write_room_files(argv[2]);
    return 0;
  }
  if (argc == 4 && std::strcmp(argv[1], "replay") == 0) {
    const replay::RecordingSource source = replay::open_source(argv[2], "");
    replay::replay_recording(*source.sensors, {}, argv[3], [](auto, const auto&, const auto&) { return true; });
    for (const std::string& d : source.sensors->damage().first) std::fprintf(stderr, "%s\n", d.c_str());
    std::fputs(replay::file_bytes((std::filesystem::path(argv[3]) / "trajectory.tum").string()).c_str(), stdout);
    return source.sensors->damage().count > 0;
  }
  std::fprintf(stderr, "bag_interop files FOLDER | replay RECORDING RUN\n");
  return 2;
} catch (const karst::core::InputError& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
