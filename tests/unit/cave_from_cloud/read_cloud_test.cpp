// Clouds of every format become points in metres with z up, or an error that helps.
#include "sdk/cave_from_cloud/read_cloud.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core_stack/common/format_text.h"
#include "tests/unit/cave_from_cloud/las_writer.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::from_cloud {
namespace {

using cave::MeshFrame;
using core::Vec3;
using core::Vec3f;
using test::error_of;
using test::Folder;
using test::put;
using test::says;

/// In metres, with z up.
std::vector<Vec3> places_of(const PointCloud& cloud) {
  std::vector<Vec3> places;
  for (const Vec3f& p : cloud.points) places.push_back(cloud.origin + p.cast<double>());
  return places;
}

std::string error_for(const std::string& file, const MeshFrame& frame = {}) {
  return error_of([&] { read_cloud(file, frame); });
}

constexpr const char* kTextHead =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\nend_header\n";

TEST(ReadCloud, NormalsOfPlyAndPcdAreRead) {
  Folder dir;
  const std::string rows = "1 2 3 0 0 2\n4 5 6 -0.5 0 0\n";
  const std::string ply = dir.write("a.PLY", kTextHead + rows);
  const std::string pcd = dir.write(
      "a.pcd",
      "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n" +
          rows);
  for (const std::string& file : {ply, pcd}) {
    const CloudFile read = read_cloud(file, {});
    EXPECT_EQ(places_of(read.cloud), (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << file;
    EXPECT_EQ(read.cloud.normals, (std::vector<Vec3f>{{0, 0, 1}, {-1, 0, 0}})) << file;
    EXPECT_FALSE(read_cloud(file, {}, false).cloud.has_normals()) << file;
  }
}

TEST(ReadCloud, TheFrameTurnsScalesAndMovesPointsAndTurnsNormals) {
  Folder dir;
  MeshFrame frame;
  frame.metres_per_unit = 0.001;
  frame.up = core::UpAxis::y;
  frame.offset = Vec3(1000, 0, 0);
  const CloudFile read =
      read_cloud(dir.write("a.ply", std::string(kTextHead) + "2000 500 3000 0 1 0\n1000 0 0 0 0 1\n"), frame);
  const std::vector<Vec3> places = places_of(read.cloud);
  EXPECT_LT((places[0] - Vec3(1, -3, 0.5)).norm(), 1e-6);
  EXPECT_LT((places[1] - Vec3(0, 0, 0)).norm(), 1e-6);
  EXPECT_LT((read.cloud.normals[0] - Vec3f(0, 0, 1)).norm(), 1e-6f);
  EXPECT_LT((read.cloud.normals[1] - Vec3f(0, -1, 0)).norm(), 1e-6f);
}

TEST(ReadCloud, PointsWithoutANormalAreLeftOutUnlessMostHaveNone) {
  Folder dir;
  const std::string head =
      std::string(kTextHead).replace(std::string(kTextHead).find("vertex 2"), 8, "vertex 3");
  const CloudFile most =
      read_cloud(dir.write("a.ply", head + "1 0 0 0 0 1\n2 0 0 nan 0 1\n3 0 0 0 1 0\n"), {});
  EXPECT_EQ(most.without_normal, 1u);
  EXPECT_EQ(places_of(most.cloud), (std::vector<Vec3>{{1, 0, 0}, {3, 0, 0}}));
  EXPECT_EQ(most.cloud.normals.size(), 2u);
  const CloudFile few = read_cloud(dir.write("b.ply", head + "1 0 0 0 0 1\n2 0 0 0 0 0\n3 0 0 0 0 0\n"), {});
  EXPECT_EQ(few.without_normal, 0u);
  EXPECT_EQ(few.cloud.points.size(), 3u);
  EXPECT_FALSE(few.cloud.has_normals());
}

TEST(ReadCloud, PointsThatAreNotFiniteAreLeftOutAndCounted) {
  Folder dir;
  const CloudFile read =
      read_cloud(dir.write("a.ply", std::string(kTextHead) + "1 2 3 0 0 1\nnan 5 inf 0 0 1\n"), {});
  EXPECT_EQ(read.points, 2u);
  EXPECT_EQ(read.not_finite, 1u);
  EXPECT_EQ(read.cloud.points.size(), 1u);
}

/// Around an easting of 672 km and a northing of 5200 km.
test::LasFile utm_cloud() {
  test::LasFile las;
  las.scale = {0.001, 0.001, 0.001};
  las.offset = {672000, 5200000, 400};
  las.points = {{{1000, 2000, 3000}}, {{41000, 82000, 9001}}, {{5, 5, 5}, true}};
  return las;
}

TEST(ReadCloud, UtmCoordinatesAreRefusedWithTheOffsetThatMendsThem) {
  Folder dir;
  const std::string file = dir.write("utm.las", utm_cloud().bytes());
  const std::string error = error_for(file);
  EXPECT_TRUE(says(error, "likely in UTM coordinates")) << error;
  EXPECT_TRUE(says(error, "offset \"672021 5200042 403\"")) << error;
  MeshFrame frame;
  frame.offset = Vec3(672021, 5200042, 403);
  const CloudFile read = read_cloud(file, frame);
  EXPECT_EQ(read.points, 3u);
  EXPECT_EQ(read.withheld, 1u);
  const std::vector<Vec3> places = places_of(read.cloud);
  EXPECT_LT((places[0] - Vec3(-20, -40, 0)).norm(), 1e-6);
  EXPECT_LT((places[1] - Vec3(20, 40, 6.001)).norm(), 1e-5) << "to a millimetre, though far from the origin";
}

TEST(ReadCloud, FarFromTheOriginTextAndDoublesAreExactAndFloatsRefused) {
  Folder dir;
  MeshFrame frame;
  frame.offset = Vec3(672000, 5200000, 0);
  const auto head = [](const std::string& format, const std::string& type) {
    return "ply\nformat " + format + " 1.0\nelement vertex 1\nproperty " + type + " x\nproperty " + type +
           " y\nproperty " + type + " z\nproperty float intensity\nend_header\n";
  };
  std::string doubles, floats;
  for (const double v : {672001.25, 5200002.125, 3.0}) {
    put(doubles, v);
    put(floats, static_cast<float>(v));
  }
  put(doubles, 0.5f);
  put(floats, 0.5f);
  const std::string little = "binary_little_endian";
  for (const std::string& bytes :
       {head("ascii", "float") + "672001.25 5200002.125 3 0.5\n", head(little, "double") + doubles})
    EXPECT_EQ(places_of(read_cloud(dir.write("a.ply", bytes), frame).cloud),
              (std::vector<Vec3>{{1.25, 2.125, 3}}));
  const std::string error = error_for(dir.write("f.ply", head(little, "float") + floats), frame);
  EXPECT_TRUE(says(error, "f.ply: holds its coordinates in single precision")) << error;
}

TEST(ReadCloud, WhatGivesNoPointIsAnErrorThatSaysWhy) {
  Folder dir;
  const auto ply = [&](const std::string& name, int points, const std::string& rows) {
    return dir.write(name, core::format_text("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\n"
                                             "property float y\nproperty float z\nend_header\n",
                                             points) +
                               rows);
  };
  EXPECT_TRUE(says(error_for(ply("none.ply", 0, "")), "none.ply: holds no point"));
  EXPECT_TRUE(says(error_for(ply("nan.ply", 1, "nan 0 0\n")), "nan.ply: holds no point with finite"));
  EXPECT_TRUE(says(error_for(ply("short.ply", 3, "1 2 3\n")), "short.ply: line 8: the file is truncated"));
  EXPECT_TRUE(says(error_for(ply("word.ply", 1, "1 two 3\n")), "word.ply: line 8"));
  EXPECT_TRUE(says(error_for(dir.write("a.laz", "")), "laszip"));
  EXPECT_TRUE(says(error_for(dir.write("a.xyz", "1 2 3\n")), "must be a .ply, .pcd or .las file"));
  EXPECT_TRUE(says(error_for("/nowhere/a.pcd"), "cannot be opened"));
  const std::string fifo = (dir.path() / "f.ply").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_TRUE(says(error_for(fifo), "f.ply: is a FIFO"));
  std::filesystem::create_directory(dir.path() / "d.pcd");
  EXPECT_TRUE(says(error_for((dir.path() / "d.pcd").string()), "d.pcd: is a directory"));
}

}  // namespace
}  // namespace karst::from_cloud
