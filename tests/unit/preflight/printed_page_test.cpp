// The page as a browser prints it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "sdk/preflight/preflight_page.h"
#include "sdk/preflight/vehicle/vehicle_page.h"
#include "tests/unit/preflight/known_mission.h"
#include "tests/unit/preflight/vehicle/known_vehicle.h"

namespace karst::preflight {
namespace {

namespace fs = std::filesystem;

/// How many pages chromium makes of it; 0 if it makes none.
std::size_t printed_pages(const std::string& html) {
  const fs::path folder = fs::path(KARST_BINARY_DIR) / "test_runs" / "preflight_printed" /
                          ::testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string page = (folder / "page.html").string(), pdf = (folder / "page.pdf").string();
  std::ofstream(page) << html;
  const std::string command =
      "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync "
      "--disable-background-networking --disable-component-update --user-data-dir='" +
      (folder / "profile").string() + "' --print-to-pdf='" + pdf + "' 'file://" + page + "' >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "chromium (.ci/packages-test)";
  std::ifstream in(pdf, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::string count = "/Count ";
  const std::size_t at = bytes.find(count);
  return at == std::string::npos ? 0 : std::stoul(bytes.substr(at + count.size()));
}

std::size_t printed_pages(const Preflight& p) { return printed_pages(preflight_page(p, findings_of(p))); }
std::size_t printed_pages(const VehicleMeasurements& m) {
  return printed_pages(vehicle_page(m, checks_of(m)));
}

/// As much text as there is: all figures, the longest reasons, and findings about all.
Preflight wordy_mission() {
  Preflight p = test::known_mission();
  p.policy->parameters.clear();
  for (int i = 0; i < 14; ++i)
    p.policy->parameters.emplace_back("min_distance_" + std::to_string(i), "12.5 m");
  p.policy->reason = std::string(60, 'a');  // a long name and 480 characters, as many as reasons have
  for (int i = 0; i < 30; ++i) p.policy->reason += " the caves flown";
  p.policy->confidence = 0.4;
  p.policy->expected[0].value = 0.3;
  p.cave->reachable_m3 = 1000;
  p.cave->blind_climb_fraction = 0.3;
  p.cave->blind_climb = "it leads 12.0 m up within 14.0 m";
  p.cave->holes.push_back({core::Vec3(1, 2, 3), 2, 4});
  p.mesh_notes = {"read as metres it is 3 km long: it is likely in millimetres (unit mm)"};
  return p;
}

// It took two pages.
TEST(PrintedPreflight, IsOnePageWithAWideCave) { EXPECT_EQ(printed_pages(test::known_mission()), 1u); }

TEST(PrintedPreflight, IsOnePageWithASquareCave) {
  Preflight p = wordy_mission();
  p.cave->plan.runs.clear();
  for (int y = 0; y < 60; ++y) p.cave->plan.runs.push_back({0, y, 60});
  EXPECT_EQ(printed_pages(p), 1u);
}

TEST(PrintedPreflight, IsOnePageWithATallCave) {
  Preflight p = wordy_mission();
  p.cave->plan.runs.clear();
  for (int y = 0; y < 300; ++y) p.cave->plan.runs.push_back({0, y, 20});
  EXPECT_EQ(printed_pages(p), 1u);
}

TEST(PrintedChecklist, IsOnePage) { EXPECT_EQ(printed_pages(test::known_vehicle()), 1u); }

TEST(PrintedChecklist, IsOnePageWithFindingsOfManyParts) {
  VehicleMeasurements m = test::known_vehicle();
  for (SensorTimeline& s : m.sensors) s.timeline.jump_s = 1;
  m.imu.mean_force_mps2 *= 1.1;
  m.motion->hand_eye->error_rad = {0.1, 0, 0};
  m.battery->fraction_left = 0.2;
  m.room.above_m = 0.5;
  m.room.seen_above = false;
  for (const char* name : {"COM_OF_LOSS_T", "COM_OBL_RC_ACT", "EKF2_EV_CTRL", "SYS_HAS_GPS", "round trip"})
    m.checks.push_back({name, "at most 1 s", "5 s", false});
  EXPECT_EQ(printed_pages(m), 1u);
}

}  // namespace
}  // namespace karst::preflight
