#include "sdk/preflight/vehicle/vehicle_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sdk/preflight/vehicle/vehicle_plots.h"
#include "sdk/preflight/vehicle/vehicle_words.h"
#include "tests/unit/preflight/vehicle/known_vehicle.h"

namespace karst::preflight {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

VehicleMeasurements with_low_battery() {
  VehicleMeasurements m = test::known_vehicle();
  m.battery->fraction_left = 0.3;
  return m;
}

TEST(VehicleWords, TheVerdictCountsWhatSpeaksAgainstIt) {
  EXPECT_EQ(verdict_text(std::vector<Check>{}), "GO");
  EXPECT_EQ(verdict_text({test::check_with(Outcome::watch), test::check_with(Outcome::watch)}),
            "GO, with 2 things to watch for");
  EXPECT_EQ(verdict_text({test::check_with(Outcome::no_go), test::check_with(Outcome::watch)}),
            "NO-GO, for 1 reason");
}

TEST(VehicleWords, SaysWhatWasMeasuredWhatIsRequiredAndWhatToDo) {
  const VehicleMeasurements m = with_low_battery();
  const std::string text = checks_text(m, checks_of(m));
  EXPECT_TRUE(text.starts_with(
      "NO-GO, for 1 reason: vehicle known <vehicle> (plugin mavlink, mission cave & co.info), listened"));
  EXPECT_TRUE(
      contains(text, "battery, charge: 30 % (required: at least 90 %). To do: charge it, or take another"));
  EXPECT_TRUE(contains(text, "  IMU: rate 200.0 Hz; ")) << text;
  EXPECT_TRUE(contains(text, "  [ ] Props"));
}

TEST(VehicleWords, JsonHasEveryCheckAndNoNumberThatIsNone) {
  VehicleMeasurements m = with_low_battery();
  m.sensors[0].timeline.latency_s = NAN;
  const std::vector<Check> checks = checks_of(m);
  const nlohmann::ordered_json j = to_json(m, checks);
  EXPECT_EQ(j["schema"], "karst.vehicle_preflight/1");
  EXPECT_EQ(j["verdict"], "no_go");
  EXPECT_EQ(j["plugin"], "mavlink");
  EXPECT_EQ(j["mission_file"], "cave & co.info");
  EXPECT_EQ(j["checks"].size(), checks.size());
  EXPECT_TRUE(j["sensors"][0]["latency_s"].is_null());
  EXPECT_EQ(j["motion"]["scans"], 250);
}

TEST(VehiclePage, ShowsVerdictReasonsPlotsAndBoxes) {
  const VehicleMeasurements m = with_low_battery();
  const std::string page = vehicle_page(m, checks_of(m));
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_TRUE(contains(page, "<p class=\"verdict no_go\">NO-GO, for 1 reason</p>"));
  EXPECT_TRUE(contains(page, "<h1>Preflight: vehicle known &lt;vehicle&gt;</h1>"));
  EXPECT_TRUE(contains(page, "By plugin mavlink, mission cave &amp; co.info."));
  EXPECT_TRUE(contains(page, "class=\"box\""));
  EXPECT_TRUE(contains(page, "Rates of the sensors over time"));
  EXPECT_TRUE(contains(page, "Rates of rotation by LiDAR and gyroscope"));
  EXPECT_TRUE(contains(page, "A scan around the pad, from above"));
}

TEST(VehiclePage, LeavesOutPlotsOfWhatWasNotMeasured) {
  VehicleMeasurements m = test::known_vehicle();
  m.motion.reset();
  m.room.points.clear();
  for (SensorTimeline& s : m.sensors) s.timeline = {};
  EXPECT_EQ(rates_svg(m), "");
  EXPECT_EQ(turns_svg(m), "");
  EXPECT_EQ(pad_svg(m), "");
  EXPECT_FALSE(contains(vehicle_page(m, checks_of(m)), "<svg"));
}

}  // namespace
}  // namespace karst::preflight
