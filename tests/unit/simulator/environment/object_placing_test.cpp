#include "plugins/simulator/environment/object_placing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/simulator_options.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using core::ObjectKind;

TEST(FlyablePlaces, ReachTheFarEndAndKeepTheirDistance) {
  const cave::Cave c = make_cave(tunnel_mesh(40, 3, 4), {3, 0, 0});
  const auto places = sim::flyable_places(c);
  double farthest = 0;
  for (const Vec3& p : places) {
    farthest = std::max(farthest, p.x());
    EXPECT_GE(c.scene.distance_to_rock(p, 1), 0.4 - 1e-9);
  }
  EXPECT_GT(farthest, 37.5);
}

// Asked for 0.6 m to rock and straight flights from cube to cube of 2 m, few places were found in caves that
// vehicles flew.
TEST(FlyablePlaces, LeadRoundTheBendsOfANarrowPassage) {
  // Three stretches of 1.2 m width: along x, then y, then x again. The last is open towards the second.
  cave::TriangleMesh m = box_mesh({-2, -0.6, -0.6}, {8, 0.6, 0.6}, 0b111101);
  append(m, box_mesh({8, 0.6, -0.6}, {9.2, 4.8, 0.6}, 0b110011));
  append(m, box_mesh({8, -0.6, -0.6}, {9.2, 0.6, 0.6}, 0b110110));
  append(m, box_mesh({8, 4.8, -0.6}, {9.2, 6, 0.6}, 0b111001));
  append(m, box_mesh({9.2, 4.8, -0.6}, {20, 6, 0.6}, 0b111110));
  const auto places = sim::flyable_places(make_cave(m));
  EXPECT_TRUE(std::any_of(places.begin(), places.end(), [](const Vec3& p) { return p.x() > 18; }));
}

TEST(PlaceObjects, OnTheFloorApartInSightAndTheSameForTheSameSeed) {
  const cave::Cave plain = make_cave(tunnel_mesh(60, 3, 5), {3, 0, 0});
  sim::ObjectOptions o;
  o.count = 8;
  cave::Cave a = plain, b = plain, other = plain;
  sim::place_objects(a, o, 11);
  sim::place_objects(b, o, 11);
  sim::place_objects(other, o, 12);
  const auto& objects = a.description.objects;
  ASSERT_EQ(objects.size(), 8u);
  const auto places = sim::flyable_places(plain);
  bool same = true;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    EXPECT_EQ(objects[i].position, b.description.objects[i].position);
    EXPECT_EQ(objects[i].kind, b.description.objects[i].kind);
    same = same && objects[i].position == other.description.objects[i].position;
    EXPECT_NE(objects[i].kind, ObjectKind::none);
    EXPECT_GE(objects[i].normal.z(), 0.7);
    EXPECT_LE(a.scene.distance_to_rock(objects[i].position, 1), 0.16);
    EXPECT_GE((objects[i].position - plain.description.start.position).norm(), 4);
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE((objects[i].position - objects[k].position).norm(), 4) << i << ' ' << k;
    EXPECT_TRUE(std::any_of(places.begin(), places.end(), [&](const Vec3& eye) {
      const Vec3 offset = objects[i].position - eye;
      return offset.norm() < 4.2 && -offset.normalized().dot(objects[i].normal) > 0.4 &&
             plain.scene.ray_cast(eye, offset, offset.norm()) >= offset.norm();
    })) << i;
  }
  EXPECT_FALSE(same);
}

TEST(PlaceObjects, WhereThereIsNoRoomSaySoAndNoneIsNone) {
  cave::Cave c = make_cave(box_mesh({-4, -4, 0}, {4, 4, 3}), {0, 0, 1});
  sim::ObjectOptions o;
  sim::place_objects(c, o, 1);
  EXPECT_TRUE(c.description.objects.empty());
  o.count = 100;
  const std::string said = error_of([&] { sim::place_objects(c, o, 1); });
  EXPECT_NE(said.find("simulator.objects.count"), std::string::npos) << said;
  EXPECT_NE(said.find("not for 100"), std::string::npos) << said;
}

TEST(ObjectOptions, RefuseANegativeCount) {
  sim::SimulatorOptions o;
  core::OptionTable table;
  describe(table, o);
  const std::string said = error_of([&] { table.set("mission.info", "objects.count", "-3"); });
  EXPECT_NE(said.find("mission.info: objects.count"), std::string::npos) << said;
}

class ObjectInCave : public testing::Test {
 protected:
  /// What reading a box of 8 m with this block says.
  std::string refusal(const std::string& block) {
    const std::string folder = scratch_folder();
    std::ofstream mesh(folder + "/box.obj");
    const auto m = box_mesh({-4, -4, 0}, {4, 4, 3});
    for (const auto& v : m.vertices) mesh << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (const auto& t : m.triangles) mesh << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    mesh.close();
    write_bytes(folder + "/box.info", "mesh box.obj\nstart \"0 0 1\"\n" + block + "\n");
    return error_of([&] { read_ = cave::load_cave(folder + "/box.info", "").description.objects; });
  }
  std::vector<cave::CaveObject> read_;
};

TEST_F(ObjectInCave, IsReadWithTheRockItLiesOn) {
  EXPECT_EQ(
      refusal("object { kind helmet position \"1 2 0.15\" }\nobject { kind rope position \"0 0 1.5\" }"), "");
  ASSERT_EQ(read_.size(), 2u);
  EXPECT_EQ(read_[0].kind, ObjectKind::helmet);
  EXPECT_LT((read_[0].normal - Vec3::UnitZ()).norm(), 1e-6);
  EXPECT_TRUE(read_[1].normal.isZero()) << "it hangs in the middle of the room";
}

TEST_F(ObjectInCave, IsRefusedWithTheReason) {
  for (const auto& [block, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"object { kind dragon position \"0 0 1\" }", {"box.info", "object.kind", "dragon", "backpack"}},
           {"object { position \"0 0 1\" }", {"object.kind", "missing"}},
           {"object { kind rope }", {"object.position", "three numbers"}},
           {"object { kind rope position \"0 0\" }", {"object.position", "three numbers"}},
           {"object { kind rope position \"0 0 nan\" }", {"object.position", "nan"}},
           {"object { kind rope position \"0 0 -0.5\" }", {"object.position", "rope", "outside of the cave"}},
           {"object { kind rope position \"90 0 1\" }", {"object.position", "outside of the cave"}},
           {"object { kind rope position \"0 0 0.005\" }", {"object.position", "0.005 m from rock"}},
           {"object { kind rope position \"0 0 1\" colour red }", {"object.colour"}}}) {
    const std::string said = refusal(block);
    for (const std::string& part : parts)
      EXPECT_NE(said.find(part), std::string::npos) << block << ": " << said;
  }
}

TEST_F(ObjectInCave, InsideABoulderIsInsideRock) {
  cave::TriangleMesh m = box_mesh({-4, -4, 0}, {4, 4, 3});
  append(m, box_mesh({1, 1, 0.5}, {3, 3, 2}));
  cave::Cave c = make_cave(m, {0, 0, 1});
  c.description.objects = {{ObjectKind::drill, {2, 2, 1.2}, Vec3::Zero()}};
  const std::string said = error_of([&] { cave::lay_objects(c); });
  EXPECT_NE(said.find("inside rock"), std::string::npos) << said;
}

}  // namespace
}  // namespace karst::test
