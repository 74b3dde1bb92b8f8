// LAS files written by the specification, and damaged ones.
#include "sdk/cave_from_cloud/las_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>

#include "tests/unit/cave_from_cloud/las_writer.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::from_cloud {
namespace {

using core::Vec3;
using test::error_of;
using test::Folder;
using test::LasFile;
using test::put;
using test::says;

class Places final : public replay::PointSink {
 public:
  std::vector<Vec3> all;
  void begin(std::span<const replay::Field> fields) override {
    for (const replay::Field& f : fields) EXPECT_EQ(f.type, replay::ValueType::float64);
  }
  void set(replay::Role role, double value) override {
    next_[static_cast<int>(role) - static_cast<int>(replay::Role::x)] = value;
  }
  void end_point() override { all.push_back(next_); }

 private:
  Vec3 next_ = Vec3::Zero();
};

std::vector<Vec3> read_places(const std::string& file, std::size_t* withheld = nullptr) {
  Places places;
  const std::size_t n = read_las(file, places);
  if (withheld != nullptr) *withheld = n;
  return places.all;
}

LasFile three_points() {
  LasFile las;
  las.points = {{{1000, -2000, 3}}, {{2147483647, -2147483647 - 1, 0}}, {{-5, 7, 99}}};
  return las;
}

TEST(LasFile, EveryVersionAndPointFormatGivesTheCoordinates) {
  Folder dir;
  // Which formats a version knows.
  constexpr std::array<unsigned, 5> kFormats{2, 2, 4, 6, 11};
  for (unsigned minor = 0; minor < kFormats.size(); ++minor)
    for (unsigned format = 0; format < kFormats[minor]; ++format)
      for (const std::size_t extra : {std::size_t{0}, std::size_t{9}}) {
        LasFile las = three_points();
        las.minor = minor;
        las.format = format;
        las.extra_bytes = extra;
        las.scale = {0.01, 0.001, 0.25};
        las.offset = {672000, 5200000, -430};
        const auto places = read_places(dir.write("a.las", las.bytes()));
        ASSERT_EQ(places.size(), 3u) << "1." << minor << ", format " << format;
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(places[i][static_cast<int>(axis)],
                      las.points[i].stored[axis] * las.scale[axis] + las.offset[axis]);
      }
}

TEST(LasFile, WithheldPointsAreDeletedOnes) {
  Folder dir;
  for (const unsigned format : {3u, 6u, 10u}) {
    LasFile las = three_points();
    las.minor = 4;
    las.format = format;
    las.points[1].withheld = true;
    std::size_t withheld = 0;
    EXPECT_EQ(read_places(dir.write("a.las", las.bytes()), &withheld).size(), 2u) << format;
    EXPECT_EQ(withheld, 1u) << format;
  }
}

TEST(LasFile, MorePointsThanOnePieceAreAllRead) {
  Folder dir;
  LasFile las;
  for (std::int32_t i = 0; i < 120000; ++i) las.points.push_back({{i, 2 * i, -i}});
  const auto places = read_places(dir.write("a.las", las.bytes()));
  ASSERT_EQ(places.size(), las.points.size());
  EXPECT_EQ(places.back(), Vec3(119999 * 0.001, 239998 * 0.001, -119999 * 0.001));
}

TEST(LasFile, CutAnywhereItIsAnErrorThatNamesTheFile) {
  Folder dir;
  for (const unsigned minor : {2u, 4u}) {
    LasFile las = three_points();
    las.minor = minor;
    const std::string bytes = las.bytes();
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      const std::string file = dir.write("cut.las", bytes.substr(0, n));
      const std::string error = error_of([&] { read_places(file); });
      EXPECT_EQ(error.rfind(file + ": byte ", 0), 0u) << n << " bytes: " << error;
    }
  }
}

template <class T>
std::string changed(const LasFile& las, std::size_t at, T value) {
  std::string bytes = las.bytes(), part;
  put(part, value);
  return bytes.replace(at, part.size(), part);
}

TEST(LasFile, HeadersThatLieAreRefusedWithPlaceAndReason) {
  Folder dir;
  const LasFile las = three_points();
  LasFile las14 = las;
  las14.minor = 4;
  const auto error = [&](const std::string& bytes) {
    return error_of([&] { read_places(dir.write("lie.las", bytes)); });
  };
  EXPECT_TRUE(says(error(changed(las, 107, std::uint32_t{4000000000u})), "declares 4000000000 points of 20"));
  EXPECT_TRUE(
      says(error(changed(las14, 247, std::uint64_t{99})), "byte 247: its header declares 99 points, and 3"));
  LasFile long14 = las14;
  long14.format = 6;
  EXPECT_TRUE(says(error(changed(long14, 247, ~std::uint64_t{0})), "declares 18446744073709551615 points"));
  EXPECT_TRUE(says(error(changed(las, 0, std::uint32_t{0})), "byte 0: is no LAS file"));
  EXPECT_TRUE(says(error(changed(las, 25, std::uint8_t{5})), "byte 24: is LAS 1.5"));
  EXPECT_TRUE(says(error(changed(las, 24, std::uint8_t{2})), "is LAS 2.2"));
  EXPECT_TRUE(says(error(changed(las, 104, std::uint8_t{11})), "byte 104: point format 11 is not known"));
  EXPECT_TRUE(says(error(changed(las, 104, std::uint8_t{1})), "byte 105: records of 20 bytes"));
  EXPECT_TRUE(says(error(changed(las, 105, std::uint16_t{0})), "byte 105: records of 0 bytes"));
  EXPECT_TRUE(says(error(changed(las, 96, std::uint32_t{100})), "byte 96: its points begin at byte 100"));
  EXPECT_TRUE(says(error(changed(las, 96, std::uint32_t{4294967295u})), "of which 0 are there"));
  EXPECT_TRUE(says(error(changed(las, 131, 0.0)), "byte 131: scale and offset"));
  EXPECT_TRUE(says(error(changed(las, 155, std::numeric_limits<double>::quiet_NaN())), "byte 131"));
}

TEST(LasFile, ACompressedFileIsRefusedWithTheToolThatUnpacksIt) {
  Folder dir;
  const std::string file = dir.write("a.las", changed(three_points(), 104, std::uint8_t{0x80}));
  EXPECT_TRUE(says(error_of([&] { read_places(file); }), "compressed (LAZ): unpack it with `laszip "));
}

TEST(LasFile, WhatIsNoRegularFileIsRefused) {
  Folder dir;
  const std::string folder = (dir.path() / "d.las").string(), fifo = (dir.path() / "f.las").string();
  std::filesystem::create_directory(folder);
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_TRUE(says(error_of([&] { read_places(folder); }), "d.las: is a directory"));
  EXPECT_TRUE(says(error_of([&] { read_places(fifo); }), "f.las: is a FIFO"));
  EXPECT_TRUE(says(error_of([&] { read_places("/nowhere/a.las"); }), "no such file"));
}

}  // namespace
}  // namespace karst::from_cloud
