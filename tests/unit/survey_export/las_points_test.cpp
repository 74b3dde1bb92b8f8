#include "sdk/survey_export/las_points.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/cave_from_cloud/las_file.h"
#include "tests/unit/replay/folder.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

class ReadPoints final : public replay::PointSink {
 public:
  std::vector<Vec3> points;
  void begin(std::span<const replay::Field>) override {}
  void set(replay::Role role, double value) override {
    if (role == replay::Role::x) place_.x() = value;
    if (role == replay::Role::y) place_.y() = value;
    if (role == replay::Role::z) place_.z() = value;
  }
  void end_point() override { points.push_back(place_); }

 private:
  Vec3 place_ = Vec3::Zero();
};

TEST(LasPoints, AreReadAgainToTheMillimetre) {
  const std::vector<Vec3> points{{451234.5678, 5078123.4321, 812.001}, {451200.1, 5078000.2, -3.9}};
  const test::Folder folder;
  ReadPoints read;
  EXPECT_EQ(from_cloud::read_las(folder.write("p.las", las_bytes(points, "p.las")), read), 0u);
  ASSERT_EQ(read.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT((read.points[i] - points[i]).cwiseAbs().maxCoeff(), 0.00051);
}

TEST(LasPoints, HaveTheHeaderOfVersion12) {
  const std::string bytes = las_bytes(std::vector<Vec3>{{1, 2, 3}}, "p.las");
  ASSERT_EQ(bytes.size(), 227u + 20u);
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(bytes[24], 1);
  EXPECT_EQ(bytes[25], 2);
  EXPECT_EQ(static_cast<unsigned char>(bytes[94]), 227);  // header size
  EXPECT_EQ(bytes[104], 0);                               // point format
  EXPECT_EQ(bytes[105], 20);                              // record length
  EXPECT_EQ(bytes[107], 1);                               // number of points
}

TEST(LasPoints, TheHeadersExtentIsThatOfTheRoundedPoints) {
  const std::string bytes = las_bytes(std::vector<Vec3>{{1.00049, 2, 3}, {5.00049, 2, 3}}, "p.las");
  std::array<double, 2> high_low{};
  std::memcpy(high_low.data(), &bytes[179], sizeof high_low);
  EXPECT_DOUBLE_EQ(high_low[0], 5.0);
  EXPECT_DOUBLE_EQ(high_low[1], 1.0);
}

TEST(LasPoints, TooFarApartAreRefused) {
  try {
    las_bytes(std::vector<Vec3>{{0, 0, 0}, {3e6, 0, 0}}, "p.las");
    FAIL();
  } catch (const core::InputError& e) {
    EXPECT_TRUE(std::string(e.what()).starts_with("p.las: too many points")) << e.what();
  }
}

}  // namespace
}  // namespace karst::survey_export
