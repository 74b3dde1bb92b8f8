// mcap_interop FOLDER: writes a made-up run into FOLDER/run, and FOLDER/run.mcap. For interop_test.sh.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "core_stack/common/little_endian.h"
#include "sdk/mcap_export/export_mcap.h"
#include "tests/unit/evaluation/fake_run.h"

namespace {

namespace fs = std::filesystem;

/// Two scans of two points each, IMU samples, a compass and a barometer, as record.scans has them.
void write_scans(const fs::path& folder) {
  fs::create_directories(folder);
  std::ofstream(folder / "recording.info")
      << "scans \"*.pcd\"\nstamp { from names unit ns of start }\ntime { unit ns of start }\n"
         "lidar { position \"0.1 0 0.2\" rotation \"0 90 0\" }\nrings { by field }\nimu { file imu.csv }\n";
  std::ofstream(folder / "imu.csv") << "t,ax,ay,az,wx,wy,wz\n0.005,0.1,0.2,9.8,0.01,0.02,0.03\n"
                                       "0.010,0.1,0.2,9.9,0.04,0.05,0.06\n";
  std::ofstream(folder / "compass.csv") << "t,x_ut,y_ut,z_ut\n0.02,20,1,-40\n";
  std::ofstream(folder / "barometer.csv") << "t,height_m\n0.02,0.1\n0.06,-1.25\n";
  for (const char* name : {"000000000000000.pcd", "000000100000000.pcd"}) {
    std::string points;
    for (int i = 0; i < 2; ++i) {
      for (const float v : {1.5f, -2.25f, 0.125f, 0.75f})
        karst::core::append_bytes(points, v + static_cast<float>(i));
      karst::core::append_bytes(points, static_cast<std::uint32_t>(12'345'678 * (i + 1)));
      karst::core::append_bytes(points, static_cast<std::uint16_t>(7 * i));
    }
    std::ofstream(folder / name, std::ios::binary) << "VERSION 0.7\nFIELDS x y z intensity t ring\nSIZE 4 4 "
                                                      "4 4 4 2\nTYPE F F F F U U\nCOUNT 1 1 1 1 1 1\n"
                                                      "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n"
                                                   << points;
  }
}

void write_pictures(const fs::path& run) {
  fs::create_directories(run / "frames");
  std::ofstream(run / "frames.csv") << "stamp_s,file,x,y,z,qx,qy,qz,qw,width,height,fx,fy,cx,cy\n"
                                       "0.500,frames/a.jpg,1,2,3,0,0,0,1,320,240,210.5,211.5,160,120\n";
  std::ofstream(run / "frames" / "a.jpg", std::ios::binary) << "\xff\xd8 begins a JPEG file";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const fs::path folder = argv[1];
    fs::remove_all(folder);
    karst::test::write_fake_run(folder / "run", {.length_m = 20});
    write_scans(folder / "run" / "scans");
    write_pictures(folder / "run");
    karst::mcap::export_mcap(folder / "run", folder / "run.mcap", {}, "test");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
