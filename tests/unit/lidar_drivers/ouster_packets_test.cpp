#include <gtest/gtest.h>

#include "plugins/lidar_drivers/ouster/imu_packet.h"
#include "tests/unit/lidar_drivers/units.h"

namespace {

using namespace karst;
using namespace karst::lidar;

OusterMetadata with_pixels(OusterProfile profile, int pixels) {
  OusterMetadata m = test::uneven_ouster(profile);
  m.altitude_deg.assign(static_cast<std::size_t>(pixels), 0);
  m.azimuth_deg = m.altitude_deg;
  return m;
}

// Worked out by hand from the sizes of header, columns, pixels and footer in Ouster SDK 0.11.
TEST(OusterPackets, HaveTheSizesOfTheirParts) {
  const auto bytes = [](OusterProfile p, int pixels) {
    return OusterLayout(with_pixels(p, pixels)).packet_bytes();
  };
  EXPECT_EQ(bytes(OusterProfile::legacy, 16), 3392u);
  EXPECT_EQ(bytes(OusterProfile::legacy, 32), 6464u);
  EXPECT_EQ(bytes(OusterProfile::legacy, 64), 12608u);
  EXPECT_EQ(bytes(OusterProfile::legacy, 128), 24896u);
  EXPECT_EQ(bytes(OusterProfile::single, 128), 24832u);
  EXPECT_EQ(bytes(OusterProfile::dual, 128), 33024u);
  EXPECT_EQ(bytes(OusterProfile::low_data, 128), 8448u);
}

void put(Packet& p, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) p[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

// Offsets are counted by hand from those in Ouster SDK 0.11: column 2 of packets with 8 pixels, pixel 3.
TEST(OusterPackets, FieldsLieAtTheBytesOfTheSdk) {
  struct Case {
    OusterProfile profile;
    std::size_t column, pixel, reflectivity;
    std::uint32_t range_mask, step_mm;
  };
  for (const Case& c : {Case{OusterProfile::legacy, 2 * 116, 2 * 116 + 16 + 36, 4, 0xfffff, 1},
                        Case{OusterProfile::single, 32 + 2 * 108, 32 + 2 * 108 + 12 + 36, 4, 0x7ffff, 1},
                        Case{OusterProfile::dual, 32 + 2 * 140, 32 + 2 * 140 + 12 + 48, 3, 0x7ffff, 1},
                        Case{OusterProfile::low_data, 32 + 2 * 44, 32 + 2 * 44 + 12 + 12, 2, 0x7fff, 8}}) {
    const OusterLayout layout(with_pixels(c.profile, 8));
    const bool legacy = c.profile == OusterProfile::legacy;
    Packet p(layout.packet_bytes(), 0xa5);
    if (!legacy) put(p, 0, 1, 2), put(p, 2, 777, 2), put(p, 7, 122322000614, 5);
    if (legacy) put(p, 10, 777, 2), put(p, c.column + 116 - 4, 0xffffffff, 4);
    put(p, c.column, 123'456'789'012, 8);
    put(p, c.column + 8, 1021, 2);
    if (!legacy) put(p, c.column + 10, 1, 2);
    put(p, c.pixel, 0xfffff & 12345, c.profile == OusterProfile::low_data ? 2 : 3);
    put(p, c.pixel + c.reflectivity, 83, legacy ? 2 : 1);

    EXPECT_TRUE(layout.is_ours(p));
    EXPECT_EQ(layout.frame_id(p), 777);
    const OusterColumnHeader h = layout.column(p, 2);
    EXPECT_EQ(h.timestamp_ns, 123'456'789'012u);
    EXPECT_EQ(h.measurement_id, 1021);
    EXPECT_TRUE(h.valid);
    EXPECT_EQ(layout.pixel(p, 2, 3).range_mm, 12345 * c.step_mm);
    EXPECT_EQ(layout.pixel(p, 2, 3).reflectivity, 83);
    put(p, legacy ? c.column + 116 - 4 : c.column + 10, 0, 2);
    EXPECT_FALSE(layout.column(p, 2).valid);
    put(p, c.pixel, 0xffffffff, c.profile == OusterProfile::low_data ? 2 : 3);  // flags beside the range
    EXPECT_EQ(layout.pixel(p, 2, 3).range_mm & ~(c.range_mask * c.step_mm), 0u);
  }
}

TEST(OusterPackets, OfAnotherSensorOrKindAreNotOurs) {
  const OusterMetadata m = test::uneven_ouster(OusterProfile::single);
  const OusterLayout layout(m);
  const Packet good = layout.blank(5);
  EXPECT_TRUE(layout.is_ours(good));
  Packet other = good;
  other[8] ^= 1;  // serial number
  EXPECT_FALSE(layout.is_ours(other));
  Packet kind = good;
  kind[0] = 2;
  EXPECT_FALSE(layout.is_ours(kind));
  EXPECT_FALSE(layout.is_ours(PacketView(good).first(good.size() - 1)));
  EXPECT_FALSE(layout.is_ours({}));
}

TEST(OusterPackets, ImuSamplesAreInGAndDegrees) {
  Packet p(48);
  put(p, 16, 987'654'321, 8);
  const auto put_float = [&](std::size_t at, float v) { put(p, at, std::bit_cast<std::uint32_t>(v), 4); };
  put_float(24, 0.5f), put_float(28, -0.25f), put_float(32, 1), put_float(36, 90), put_float(40, -180),
      put_float(44, 2);
  const auto s = read_ouster_imu(p);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->stamp, 987'654'321);
  EXPECT_LT((s->specific_force_mps2 - core::Vec3(4.903325, -2.4516625, 9.80665)).norm(), 1e-6);
  EXPECT_LT((s->body_rate_radps - core::Vec3(std::numbers::pi / 2, -std::numbers::pi, std::numbers::pi / 90))
                .norm(),
            1e-6);
  const auto again = read_ouster_imu(ouster_imu_packet(*s));
  ASSERT_TRUE(again);
  EXPECT_LT((again->specific_force_mps2 - s->specific_force_mps2).norm(), 1e-5);
  EXPECT_LT((again->body_rate_radps - s->body_rate_radps).norm(), 1e-6);
  put_float(24, std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(read_ouster_imu(p));
  EXPECT_FALSE(read_ouster_imu(PacketView(p).first(47)));
}

}  // namespace
