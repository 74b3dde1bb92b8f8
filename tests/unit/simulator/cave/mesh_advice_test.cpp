#include "plugins/simulator/cave/mesh_advice.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using cave::MeshAdvice;
using cave::MeshFrame;
using cave::TriangleMesh;

std::vector<MeshAdvice> advice_on(TriangleMesh mesh, const MeshFrame& frame = {}) {
  return cave::mesh_advice(cave::shape_of(cave::RayScene(std::move(mesh))), frame);
}

std::vector<std::string> remedies_for(TriangleMesh mesh, const MeshFrame& frame = {}) {
  std::vector<std::string> remedies;
  for (const MeshAdvice& a : advice_on(std::move(mesh), frame)) remedies.push_back(a.remedy);
  return remedies;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3f& v : mesh.vertices) v *= static_cast<float>(factor);
  return mesh;
}

/// Level corridors 3 m wide and 2 m high, with three corners, and a hall.
TriangleMesh maze() {
  std::set<std::array<int, 3>> cells;
  fill(cells, {0, 0, 0}, {20, 3, 2});
  fill(cells, {17, 0, 0}, {20, 20, 2});
  fill(cells, {0, 17, 0}, {20, 20, 2});
  fill(cells, {0, 12, 0}, {8, 20, 4});
  return lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
}

using Remedies = std::vector<std::string>;

TEST(MeshAdvice, ACaveInMetresWithZUpNeedsNone) {
  EXPECT_EQ(remedies_for(maze()), Remedies{});
  EXPECT_EQ(remedies_for(box_mesh({0, 0, 0}, {4, 4, 4})), Remedies{});
  EXPECT_EQ(remedies_for(tunnel_mesh(40, 3, 1)), Remedies{});
  EXPECT_TRUE(cave::mesh_advice({}, {}).empty()) << "of nothing, nothing is known";
}

TEST(MeshAdvice, MillimetresAndCentimetresAreRecognised) {
  EXPECT_EQ(remedies_for(box_mesh({0, 0, 0}, {4000, 4000, 4000})), Remedies{"unit mm"});
  EXPECT_EQ(remedies_for(scaled(maze(), 1000)), Remedies{"unit mm"});
  EXPECT_EQ(remedies_for(scaled(maze(), 100)), Remedies{"unit cm"});
}

TEST(MeshAdvice, OnlyWhatIsCertainIsSaidAsCertain) {
  const auto finding = [](const TriangleMesh& mesh) { return advice_on(mesh).at(0).finding; };
  EXPECT_NE(finding(box_mesh({0, 0, 0}, {8000, 8000, 8000})).find("8000 m across: it is in millimetres"),
            std::string::npos);
  EXPECT_NE(finding(scaled(maze(), 1000)).find("in another unit, most likely in millimetres"),
            std::string::npos);
  EXPECT_NE(finding(scaled(maze(), 100)).find("it is likely in centimetres"), std::string::npos);
}

TEST(MeshAdvice, AMeshThatIsInItsRightUnitNeedsNone) {
  MeshFrame mm;
  mm.metres_per_unit = 0.001;
  EXPECT_EQ(remedies_for(maze(), mm), Remedies{}) << "as read, it is in metres";
}

TriangleMesh turned(TriangleMesh mesh) {
  for (Vec3f& v : mesh.vertices) v = Vec3f(v.x(), v.z(), -v.y());
  return mesh;
}

TEST(MeshAdvice, YUpIsSaidAsLikely) {
  const std::vector<MeshAdvice> advice = advice_on(turned(maze()));
  ASSERT_EQ(advice.size(), 1u);
  EXPECT_EQ(advice[0].remedy, "up y");
  EXPECT_NE(advice[0].finding.find("likely has y up"), std::string::npos) << advice[0].finding;
  MeshFrame y;
  y.up = core::UpAxis::y;
  EXPECT_EQ(remedies_for(turned(maze()), y), Remedies{"up z"}) << "what was turned without need";
  MeshFrame own;
  own.states_its_own = true;
  EXPECT_EQ(remedies_for(turned(maze()), own), Remedies{}) << "Collada states its axis";
  EXPECT_EQ(remedies_for(scaled(maze(), 1000), own), Remedies{"scale 0.001"});
}

TEST(MeshAdvice, AnUprightShaftIsNoMeshWithYUp) {
  EXPECT_EQ(remedies_for(box_mesh({0, 0, 0}, {6, 5, 50})), Remedies{});
}

/// The offset that a remedy names.
Vec3 offset_in(const std::string& remedy) {
  Vec3 o = Vec3::Constant(std::nan(""));
  EXPECT_EQ(std::sscanf(remedy.c_str(), "offset \"%lf %lf %lf\"", &o.x(), &o.y(), &o.z()), 3) << remedy;
  return o;
}

RC_GTEST_PROP(MeshAdvice, TheOffsetThatIsNamedBringsTheMeshToTheOrigin, ()) {
  const auto number = [](int low, int high) { return static_cast<double>(*rc::gen::inRange(low, high)); };
  MeshFrame frame;
  frame.metres_per_unit = *rc::gen::element(1.0, 0.01, 0.001, 0.3048);
  frame.up = *rc::gen::element(core::UpAxis::z, core::UpAxis::y);
  const Vec3 low(number(-900'000, 900'000), number(-9'000'000, 9'000'000), number(-500, 4000));
  const Vec3 size(number(5, 800), number(5, 800), number(5, 800));
  cave::MeshShape shape;
  shape.box = Eigen::AlignedBox3d(low, low + size);
  const double away_m = shape.box.min().cwiseAbs().cwiseMax(shape.box.max().cwiseAbs()).maxCoeff();
  const std::vector<MeshAdvice> advice = cave::mesh_advice(shape, frame);
  if (away_m < 1e4) {
    RC_ASSERT(advice.empty());
    return;
  }
  RC_ASSERT(advice.size() == 1u);
  frame.offset = offset_in(advice[0].remedy);
  const Vec3 back =
      cave::to_metres(frame, cave::to_file({frame.metres_per_unit, frame.up}, low) - frame.offset);
  RC_ASSERT(back.cwiseAbs().maxCoeff() <= size.maxCoeff() + 2);
}

TEST(MeshAdvice, MillimetresFarAwayGetAUnitAndAnOffset) {
  cave::MeshShape shape;  // as the reader has it that refuses them: nothing but the box
  shape.box = Eigen::AlignedBox3d(Vec3(4.2e8, 5.2e9, 1e6), Vec3(4.2e8 + 3e5, 5.2e9 + 2e5, 1.05e6));
  const std::vector<MeshAdvice> advice = cave::mesh_advice(shape, {});
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].remedy, "unit mm");
  EXPECT_EQ(advice[1].remedy, "offset \"420150000 5200100000 1000000\"");
  EXPECT_NE(advice[1].finding.find("5200 km from the origin, likely in UTM coordinates"), std::string::npos)
      << advice[1].finding;
}

TEST(MeshAdvice, ASmallCaveInMillimetresOfUtmGetsAUnitToo) {
  cave::MeshShape shape;  // 70 m long: its size alone tells nothing before its passages are known
  shape.box = Eigen::AlignedBox3d(Vec3(4.2e8, 5.2e9, 1e6), Vec3(4.2e8 + 7e4, 5.2e9 + 1.2e4, 1.009e6));
  MeshFrame bare;
  bare.given_as_options = true;
  const std::vector<MeshAdvice> advice = cave::mesh_advice(shape, bare);
  ASSERT_EQ(advice.size(), 2u);
  EXPECT_EQ(advice[0].remedy, "unit mm");
  EXPECT_NE(advice[0].finding.find("farther than any place on Earth"), std::string::npos);
  EXPECT_EQ(advice[1].remedy, "offset \"420035000 5200006000 1000000\"");
  const std::string refused = cave::reach_problem(shape.box, bare);
  EXPECT_NE(refused.find("(--unit mm)"), std::string::npos) << refused;
  EXPECT_NE(refused.find("(--offset \"420035000 "), std::string::npos) << refused;
  shape.box = Eigen::AlignedBox3d(Vec3(4.2e7, 5.2e8, 1e5), Vec3(4.2e7 + 7e3, 5.2e8 + 1.2e3, 1.009e5));
  EXPECT_EQ(cave::mesh_advice(shape, {}).at(0).remedy, "unit cm");
}

TEST(MeshAdvice, ARemedyIsWordedAsItIsGiven) {
  MeshFrame bare;
  bare.given_as_options = true;
  const TriangleMesh large = box_mesh({0, 0, 0}, {4000, 4000, 4000});
  EXPECT_EQ(advice_on(large, bare).at(0).to_give, "--unit mm");
  EXPECT_EQ(advice_on(large).at(0).to_give, "unit mm") << "a key of the cave file";
  EXPECT_NE(cave::to_text(advice_on(large, bare).at(0)).find("(--unit mm)"), std::string::npos);
}

std::string hint_on(TriangleMesh mesh, bool bare = true) {
  MeshFrame frame;
  frame.given_as_options = bare;
  return cave::axis_hint(cave::shape_of(cave::RayScene(std::move(mesh))), frame);
}

TEST(AxisHint, IsGivenWhereTheShapeDoesNotTellTheAxis) {
  EXPECT_NE(hint_on(box_mesh({0, 0, -4}, {20, 4, 0})).find("--up y"), std::string::npos)
      << "a straight tunnel";
  EXPECT_NE(hint_on(box_mesh({0, 0, 0}, {6, 5, 50})), "") << "a shaft, or a tunnel with y up";
  EXPECT_NE(hint_on(box_mesh({0, 0, 0}, {30, 20, 40})), "")
      << "most of it faces along y, as floor and roof do";
}

TEST(AxisHint, IsNotGivenWhereTheShapeOrTheUserTells) {
  EXPECT_EQ(hint_on(maze()), "");
  EXPECT_EQ(hint_on(box_mesh({0, 0, 0}, {20, 12, 4})), "") << "wider than high";
  EXPECT_EQ(hint_on(box_mesh({0, 0, 0}, {4, 40, 4})), "") << "along y, which is not up";
  EXPECT_EQ(hint_on(turned(maze())), "") << "there is advice";
  EXPECT_EQ(hint_on(box_mesh({0, 0, -4}, {20, 4, 0}), false), "") << "a cave file states the axis";
  EXPECT_EQ(cave::axis_hint({}, {}), "");
}

}  // namespace
}  // namespace karst::test
