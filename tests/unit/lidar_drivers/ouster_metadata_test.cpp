#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "tests/unit/lidar_drivers/units.h"

namespace {

using namespace karst;
using namespace karst::lidar;

constexpr const char* kFlat = R"({
  "prod_line": "OS-1-128", "prod_sn": "992008000494", "lidar_mode": "2048x10", "build_rev": "v2.0.0",
  "beam_altitude_angles": [20, 0.5, -21], "beam_azimuth_angles": [4.25, 1.42, -4.25],
  "lidar_origin_to_beam_origin_mm": 15.806,
  "lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1],
  "imu_to_sensor_transform": [1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1],
  "data_format": {"column_window": [2014, 36], "columns_per_frame": 2048, "columns_per_packet": 16,
                  "pixel_shift_by_row": [48, 32, 0], "pixels_per_column": 3}})";

TEST(OusterMetadata, IsReadFromTheFlatJsonOfEarlyFirmware) {
  const OusterMetadata m = ouster_metadata_of(kFlat, "f");
  EXPECT_EQ(m.product, "OS-1-128");
  EXPECT_EQ(m.serial, 992008000494u);
  EXPECT_EQ(m.profile, OusterProfile::legacy);
  EXPECT_EQ(m.rate_hz, 10);
  EXPECT_EQ(m.altitude_deg, (std::vector<double>{20, 0.5, -21}));
  EXPECT_EQ(m.beam_origin_mm, 15.806);
  EXPECT_EQ(m.columns_in_window(), 2048 - 2014 + 37);  // across column 0
  EXPECT_TRUE(m.in_window(2047) && m.in_window(0) && m.in_window(36));
  EXPECT_FALSE(m.in_window(37) || m.in_window(2013));
  EXPECT_DOUBLE_EQ(lidar_model(m, {}).T_body_lidar.position.z(), 0.03618);
}

TEST(OusterMetadata, IsTheSameAfterItWasWrittenInGroups) {
  for (const auto& name : names_of(OusterProfile{})) {
    OusterMetadata m = test::uneven_ouster(name.value);
    m.first_column = 12, m.last_column = 50;
    const OusterMetadata again = ouster_metadata_of(json_text_of(m), "f");
    EXPECT_EQ(again.product, m.product);
    EXPECT_EQ(again.serial, m.serial);
    EXPECT_EQ(again.profile, m.profile);
    EXPECT_EQ(again.first_column, 12);
    EXPECT_EQ(again.last_column, 50);
    EXPECT_EQ(again.altitude_deg, m.altitude_deg);
    EXPECT_EQ(again.azimuth_deg, m.azimuth_deg);
    EXPECT_EQ(again.beam_origin_mm, m.beam_origin_mm);
    EXPECT_EQ(again.lidar_to_sensor, m.lidar_to_sensor);
    EXPECT_EQ(again.imu_to_sensor, m.imu_to_sensor);
  }
}

TEST(OusterMetadata, OfAModelGivesTheModelBack) {
  core::LidarModel model;
  model.columns = 512;
  model.elevation_rad = {0.4f, 0.1f, -0.3f};
  const core::LidarModel again = lidar_model(metadata_for(model, OusterProfile::single), {});
  EXPECT_EQ(again.columns, 512);
  EXPECT_EQ(again.period, model.period);
  EXPECT_TRUE(again.azimuth_offset_rad.empty());
  EXPECT_LT(again.T_body_lidar.orientation.angularDistance(core::Quat::Identity()), 1e-12);
  for (int c = 0; c < 3; ++c)
    for (const int j : {0, 77, 511}) EXPECT_LT((again.direction(c, j) - model.direction(c, j)).norm(), 1e-6f);
}

TEST(OusterMetadata, WhatCannotBeIsRefusedByItsKey) {
  struct Case {
    const char *from, *to, *expected;
  };
  for (const Case& c : std::initializer_list<Case>{
           {"{", "[", "f: is no JSON object"},
           {"2048x10", "1024x10", "contradicts columns_per_frame 2048"},
           {"2048x10", "2048x", "lidar_mode: is not"},
           {"2048x10", "2048x0", "lidar_mode: is not"},
           {"\"lidar_mode\"", "\"mode\"", "lidar_mode: is missing"},
           {"20, 0.5", "20, 95", "beam_altitude_angles: must be a number"},
           {"20, 0.5", "0.5, 20", "beam_altitude_angles: must descend"},
           {"[4.25, 1.42, -4.25]", "[4.25, 1.42]", "beam_azimuth_angles: has not as many"},
           {"[4.25, 1.42, -4.25]", "[4.25, \"1\", 2]", "beam_azimuth_angles: must be a number"},
           {"[4.25, 1.42, -4.25]", "[]", "beam_azimuth_angles: must be a list"},
           {"\"pixels_per_column\": 3", "\"pixels_per_column\": 4",
            "pixels_per_column: is not the number of beams, 3"},
           {"\"columns_per_frame\": 2048", "\"columns_per_frame\": 1e9",
            "columns_per_frame: must be a whole number"},
           {"\"columns_per_packet\": 16", "\"columns_per_packet\": 0", "columns_per_packet: must be a whole"},
           {"2048, \"columns_per_packet\": 16", "2048, \"columns_per_packet\": 129",
            "columns_per_packet: must be"},
           {"[2014, 36]", "[2014, 5000]", "column_window: must be a number"},
           {"[2014, 36]", "[2014]", "column_window: must have 2"},
           {"[-1, 0, 0, 0, 0, -1", "[-1, 0, 0, 0, 0, 1", "lidar_to_sensor_transform: is no rotation"},
           {"992008000494", "-5", "prod_sn: is not a serial number"},
           {"\"data_format\": {", "\"data_format\": {\"udp_profile_lidar\": \"FIVE\", ",
            "\"FIVE\" is not supported"}}) {
    std::string text = kFlat;
    text.replace(text.find(c.from), std::string(c.from).size(), c.to);
    try {
      ouster_metadata_of(text, "f");
      ADD_FAILURE() << c.to << " was taken";
    } catch (const core::InputError& e) {
      EXPECT_NE(std::string(e.what()).find(c.expected), std::string::npos) << e.what();
    }
  }
}

// The formula of Ouster SDK 0.11: point = (r - n) direction + n (cos encoder, sin encoder), in Ouster's
// frames.
TEST(OusterMetadata, BeamsLieWhereTheSdkPutsThem) {
  const OusterMetadata m = test::uneven_ouster(OusterProfile::single, 1024);
  const core::LidarModel model = lidar_model(m, {});
  const double rad = std::numbers::pi / 180, n = m.beam_origin_mm, r_mm = 4321;
  for (std::size_t beam = 0; beam < 8; ++beam)
    for (const int id : {0, 1, 300, 767, 1023}) {
      const double encoder = 2 * std::numbers::pi * (1 - id / 1024.0), a = -m.azimuth_deg[beam] * rad,
                   e = m.altitude_deg[beam] * rad;
      const core::Vec3 in_lidar((r_mm - n) * std::cos(encoder + a) * std::cos(e) + n * std::cos(encoder),
                                (r_mm - n) * std::sin(encoder + a) * std::cos(e) + n * std::sin(encoder),
                                (r_mm - n) * std::sin(e));
      const core::Vec3 in_sensor(-in_lidar.x() / 1000, -in_lidar.y() / 1000, in_lidar.z() / 1000 + 0.03618);
      const auto range_m = static_cast<float>((r_mm - n) / 1000);
      const core::Vec3f point = model.origin(id) + range_m * model.direction(static_cast<int>(beam), id);
      // The beam's origin is put at the column's own azimuth, half a column off: 0.1 mm.
      EXPECT_LT((model.T_body_lidar * point.cast<double>() - in_sensor).norm(), 1.5e-4) << beam << " " << id;
    }
}

}  // namespace
