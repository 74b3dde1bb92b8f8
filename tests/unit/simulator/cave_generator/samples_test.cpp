#include "plugins/simulator/cave_generator/samples.h"

#include <gtest/gtest.h>

#include <map>

#include "core_stack/common/random.h"
#include "plugins/simulator/cave/mesh_volume.h"
#include "plugins/simulator/cave_generator/surface_net.h"

namespace {

using namespace karst::cave;
using karst::core::Vec3;

CavePlan one_chamber(double radius_m) {
  CavePlan plan;
  plan.chambers.push_back({Vec3::Zero(), Vec3::Constant(radius_m), 0, -10});
  plan.roughness_m = plan.undulation_m = 0;
  plan.start = Vec3::Zero();
  return plan;
}

std::size_t odd_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++runs[{t[i], t[(i + 1) % 3]}];
  std::size_t odd = 0;
  for (const auto& [edge, n] : runs) {
    const auto back = runs.find({edge.second, edge.first});
    odd += n != 1 || back == runs.end() || back->second != 1;
  }
  return odd;
}

TEST(SurfaceNet, BallHasTheVolumeOfABall) {
  const CavePlan plan = one_chamber(3);
  const double grid_m = 0.2;
  const CaveField field(plan, Samples::kEdge * grid_m, 0.5);
  Samples samples(field, grid_m);
  const TriangleMesh mesh = surface_net(samples);
  const double ball = 4.0 / 3 * std::numbers::pi * 27;
  EXPECT_NEAR(enclosed_volume_m3(mesh), ball, 0.02 * ball);  // positive: normals point inwards
  EXPECT_EQ(odd_edges(mesh), 0u);
  for (const auto& v : mesh.vertices) EXPECT_NEAR(v.norm(), 3, 0.05);
}

TEST(SeparateSheets, MakesAnyRandomRockAManifold) {
  const CavePlan plan = one_chamber(2);
  const CaveField field(plan, Samples::kEdge * 0.3, 0.5);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Samples samples(field, 0.3);
    karst::core::Random random(seed);
    samples.for_each([&](const Node& n) {  // noise, but for the border, which stays rock
      if (samples.position(n).cwiseAbs().maxCoeff() < 2.2)
        samples.set(n, static_cast<float>(random.uniform(-1, 1)));
    });
    const std::size_t before = odd_edges(surface_net(samples));
    separate_sheets(samples);
    EXPECT_GT(before, 0u);
    EXPECT_EQ(odd_edges(surface_net(samples)), 0u) << "seed " << seed;
  }
}

TEST(KeepOneCave, FillsOtherHollowsAndRemovesHangingRock) {
  const CavePlan plan = one_chamber(3);
  const CaveField field(plan, Samples::kEdge * 0.3, 0.5);
  Samples samples(field, 0.3);
  const double whole = hollow_volume_m3(samples);
  const Node hanging = samples.nearest({0.9, 0, 0}), bubble = samples.nearest({3.6, 0, 0});
  ASSERT_TRUE(samples.has_block(bubble));
  samples.set(hanging, 1);
  samples.set(bubble, -1);
  keep_one_cave(samples, Vec3::Zero());
  EXPECT_TRUE(samples.hollow(hanging));
  EXPECT_FALSE(samples.hollow(bubble));
  EXPECT_DOUBLE_EQ(hollow_volume_m3(samples), whole);
}

TEST(Field, WholePartsToldAtOnceAgreeWithSinglePlaces) {
  CavePlan plan = lay_out(cave_preset("small"), 5, 80);
  furnish(plan, cave_preset("small"), 5);
  const double grid_m = 0.6;
  const CaveField field(plan, Samples::kEdge * grid_m, 0.8);
  const Samples samples(field, grid_m);
  std::size_t different = 0, hollow = 0;
  samples.for_each([&](const Node& n) {
    const double value = field.value(samples.position(n));
    hollow += samples.hollow(n);
    different += samples.hollow(n) != (value < 0);
  });
  EXPECT_GT(hollow, 1000u);
  EXPECT_EQ(different, 0u);
}

}  // namespace
