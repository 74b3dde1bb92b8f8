// Which coordinate systems are refused since they are in degrees.
#include "sdk/survey_export/geographic_system.h"

#include <gtest/gtest.h>

namespace karst::survey_export {
namespace {

TEST(GeographicSystem, LatitudeAndLongitudeAreToldByTheirCodes) {
  // WGS 84, ETRS89, NAD83, NAD83(2011), GDA94, GDA2020, RGF93, CH1903+, JGD2011, CGCS2000, WGS 84 in 3D
  for (const int code : {4326, 4258, 4269, 6318, 4283, 7844, 4171, 4150, 4979, 4490})
    EXPECT_TRUE(is_geographic("EPSG:" + std::to_string(code))) << code;
  for (const char* name : {"ESRI:104000", "ESRI:37001", "lat-long", "long-lat"})
    EXPECT_TRUE(is_geographic(name)) << name;
}

TEST(GeographicSystem, SystemsInMetresAreNot) {
  // UTM, Lambert-93, British grid, MGI Austria, ETRS89 UTM 32N with its zone, GDA94 MGA, New Zealand, Swiss
  for (const int code : {32633, 2154, 27700, 31256, 4647, 28355, 2193, 2056, 25833, 4087, 4217})
    EXPECT_FALSE(is_geographic("EPSG:" + std::to_string(code))) << code;
  for (const char* name : {"UTM33N", "ESRI:102013", "", "EPSG:", "EPSG:4326x", "EPSG:99999999999"})
    EXPECT_FALSE(is_geographic(name)) << name;
}

}  // namespace
}  // namespace karst::survey_export
