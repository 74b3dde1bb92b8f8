#include "plugins/simulator/cave/cave.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

class CaveFiles : public testing::Test {
 protected:
  CaveFiles() { cave::write_mesh(folder_ + "/box.ply", box_mesh({-5, -5, 0}, {5, 5, 4})); }
  std::string info(const std::string& text) const {
    write_bytes(folder_ + "/cave.info", text);
    return folder_ + "/cave.info";
  }
  std::string error_for(const std::string& text, const std::string& start = "") const {
    const std::string file = info(text);
    return error_of([&] { cave::load_cave(file, start); });
  }
  std::string folder_ = scratch_folder();
};

TEST_F(CaveFiles, BouldersAreReadAndTheirMistakesNamed) {
  const std::string head = "mesh box.ply\nstart \"0 0 2\"\n";
  const cave::Cave c = cave::load_cave(
      info(
          head +
          R"(boulder { position "3 0 1" radius "150 cm" after "20 s" within "6 m" to "3 4 1" speed "1 m/s" })"
          "\nboulder { position \"1 1 1\" }\n"),
      "");
  ASSERT_EQ(c.description.boulders.size(), 2u);
  const cave::LooseRock& b = c.description.boulders[0];
  EXPECT_EQ(b.to, Vec3(3, 4, 1));
  EXPECT_EQ(b.radius_m, 1.5);
  EXPECT_EQ(b.after_s, 20);
  EXPECT_EQ(b.within_m, 6);
  EXPECT_EQ(b.speed_mps, 1);
  EXPECT_EQ(c.description.boulders[1].to, Vec3(1, 1, 1));
  EXPECT_NE(error_for(head + "boulder { radius \"1 m\" }").find("boulder.position"), std::string::npos);
  EXPECT_NE(error_for(head + "boulder { position \"0 0 0\" radius \"1 s\" }").find("boulder.radius"),
            std::string::npos);
}

TEST_F(CaveFiles, CloudsAndFaultsAreRead) {
  const cave::CaveDescription c =
      cave::load_cave(info("mesh box.ply\nstart \"0 0 2\"\n"
                           "cloud { position \"3 0 1\" radius \"150 cm\" extinction \"0.4 1/m\" of droplets "
                           "after \"20 s\" }\n"
                           "cloud { position \"1 1 1\" size \"4 2 1\" extinction \"50 1/km\" }\n"
                           "fault { sensor lidar after \"40 s\" for \"1500 ms\" }\n"
                           "fault { sensor lidar kind stamp_back after 50 }\n"
                           "fault { sensor camera kind lost after 60 for 2 }\n"),
                      "")
          .description;
  ASSERT_EQ(c.clouds.size(), 2u);
  EXPECT_FALSE(c.clouds[0].box);
  EXPECT_EQ(c.clouds[0].half_size_m, Vec3(1.5, 1.5, 1.5));
  EXPECT_EQ(c.clouds[0].extinction_1pm, 0.4);
  EXPECT_EQ(c.clouds[0].lidar_ratio_sr, cave::Cloud::kDroplets_sr);
  EXPECT_EQ(c.clouds[0].after_s, 20);
  EXPECT_TRUE(c.clouds[1].box);
  EXPECT_EQ(c.clouds[1].half_size_m, Vec3(2, 1, 0.5));
  EXPECT_NEAR(c.clouds[1].extinction_1pm, 0.05, 1e-12);
  EXPECT_EQ(c.clouds[1].lidar_ratio_sr, cave::Cloud::kDust_sr);
  ASSERT_EQ(c.faults.size(), 3u);
  EXPECT_EQ(c.faults[0].kind, cave::Fault::Kind::lost);
  EXPECT_EQ(c.faults[0].lasts_s, 1.5);
  EXPECT_EQ(c.faults[1].kind, cave::Fault::Kind::stamp_back);
  EXPECT_EQ(c.faults[1].lasts_s, 0);
  EXPECT_EQ(c.faults[2].sensor, cave::Fault::Sensor::camera);
}

TEST_F(CaveFiles, InfoFileIsReadWithItsMeshBesideIt) {
  const cave::Cave c = cave::load_cave(info(R"(
mesh box.ply
start "1 2 1.5 90"
reflectivity 0.4
patch { position "5 0 2"  radius "300 cm"  reflectivity 0.9 }
ore { position "3 0 -1"  moment "0 0 4000" }
ore { position "4 0 -1"  moment "10 0 0" }
)"),
                                       "");
  EXPECT_EQ(c.scene.mesh().triangles.size(), 12u);
  EXPECT_EQ(c.description.start.position, Vec3(1, 2, 1.5));
  EXPECT_NEAR(c.description.start.heading_rad, std::numbers::pi / 2, 1e-12);
  ASSERT_EQ(c.description.ore_bodies.size(), 2u);
  EXPECT_EQ(c.description.ore_bodies[0].moment_am2, Vec3(0, 0, 4000));
  EXPECT_EQ(cave::reflectivity_at(c.description, {-5, 0, 2}), 0.4);
  EXPECT_EQ(cave::reflectivity_at(c.description, {5, 2.9, 2}), 0.9);
}

TEST_F(CaveFiles, AStartThatIsGivenReplacesTheFilesOwn) {
  const cave::Cave c = cave::load_cave(info("mesh box.ply\nstart \"1 2 1.5 90\""), "-1 0 1");
  EXPECT_EQ(c.description.start.position, Vec3(-1, 0, 1));
  EXPECT_EQ(c.description.start.heading_rad, 0);
}

TEST_F(CaveFiles, ABareMeshNeedsAStart) {
  EXPECT_NE(error_of([&] { cave::load_cave(folder_ + "/box.ply", ""); }).find("start"), std::string::npos);
  EXPECT_EQ(cave::load_cave(folder_ + "/box.ply", "1 1 1 45").description.start.position, Vec3(1, 1, 1));
  EXPECT_FALSE(cave::has_start(folder_ + "/box.ply"));
  EXPECT_FALSE(cave::has_start(info("mesh box.ply")));
  EXPECT_TRUE(cave::has_start(info("mesh box.ply\nstart \"0 0 1\"")));
}

TEST_F(CaveFiles, TheFrameOfTheMeshIsReadAndTheStartIsInMetres) {
  // In the file 10 x 4 x 10 m in millimetres with y up, 1 m, 2 m and 3 m off its origin.
  cave::write_mesh(folder_ + "/mm.ply", box_mesh({1000, 2000, 3000}, {11000, 6000, 13000}));
  const cave::Cave c =
      cave::load_cave(info("mesh mm.ply\nunit mm\nup y\noffset \"1000 2000 3000\"\nstart \"5 -5 1\"\n"), "");
  const Eigen::AlignedBox3d box = box_of(c.scene.mesh());
  EXPECT_LT((box.min() - Vec3(0, -10, 0)).norm(), 1e-5) << box.min().transpose();
  EXPECT_LT((box.max() - Vec3(10, 0, 4)).norm(), 1e-5) << box.max().transpose();
  EXPECT_EQ(c.description.start.position, Vec3(5, -5, 1));
  const core::MeshKeys keys{1, core::MeshUnit::mm, core::UpAxis::y, "1000 2000 3000"};
  const cave::Cave bare = cave::load_cave(folder_ + "/mm.ply", "5 -5 1", keys);
  EXPECT_EQ(bare.scene.mesh().vertices, c.scene.mesh().vertices);
  const cave::MeshFile mesh = cave::mesh_of(folder_ + "/mm.ply", keys);
  EXPECT_EQ(cave::to_text(mesh.frame), cave::to_text(c.description.mesh_frame));
  EXPECT_EQ(cave::load_mesh(mesh).vertices, c.scene.mesh().vertices);
}

TEST_F(CaveFiles, MistakesInTheFrameOfTheMeshAreNamed) {
  const std::string head = "mesh box.ply\nstart \"0 0 1\"\n";
  const auto expect = [&](const std::string& line, const std::string& part) {
    const std::string e = error_for(head + line);
    EXPECT_NE(e.find(part), std::string::npos) << "\"" << e << "\" lacks \"" << part << "\"";
    EXPECT_NE(e.find("cave.info"), std::string::npos) << e;
  };
  expect("unit furlong", "unit: expected one of m cm mm ft in, got \"furlong\"");
  expect("unit \"mm cm\"", "unit: expected one of");
  expect("scale 0", "scale: expected a number in 1e-06 to 1e+06, got \"0\"");
  expect("scale -1", "scale: expected a number");
  expect("scale nan", "scale: expected a number");
  expect("scale \"2 m\"", "this key has no unit");
  expect("up x", "up: expected one of z y, got \"x\"");
  expect("offset \"1 2\"", "offset: expected three numbers \"x y z\", got \"1 2\"");
  expect("offset \"1 2 nan\"", "offset: expected three numbers");
  expect("offset 1", "offset: expected three numbers");
  expect("unit mm\nunit cm", "unit: given twice");
  expect("units mm", "did you mean unit?");
  const std::string beside = error_of([&] {
    cave::describe_cave(info(head), "", {1, core::MeshUnit::mm, core::UpAxis::z, ""});
  });
  EXPECT_NE(beside.find("cave.info: is a cave file"), std::string::npos) << beside;
}

TEST_F(CaveFiles, ErrorsNameTheKeyAndWhatWasExpected) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    const std::string e = error_for(text);
    EXPECT_NE(e.find(part), std::string::npos) << "\"" << e << "\" lacks \"" << part << "\"";
    EXPECT_NE(e.find("cave.info"), std::string::npos) << e;
  };
  expect("mash box.ply\nstart \"0 0 1\"", "did you mean mesh?");
  expect("start \"0 0 1\"", "mesh: missing");
  expect("mesh box.ply", "start: missing");
  expect("mesh box.ply\nstart \"0 0\"", "x y z");
  expect("mesh box.ply\nstart \"0 0 up\"", "x y z");
  expect("mesh box.ply\nstart \"0 0 1 0 0\"", "x y z");
  expect("mesh box.ply\nstart \"0 0 nan\"", "x y z");
  expect("mesh box.ply\nstart \"0 0 1\"\nreflectivity 2", "0 to 1");
  expect("mesh box.ply\nstart \"0 0 1\"\npatch { position \"0 0 0\" radus 3 }", "did you mean patch.radius?");
  expect("mesh box.ply\nstart \"0 0 1\"\nore { position \"0 0 0\" }", "ore.moment");
  const std::string head = "mesh box.ply\nstart \"0 0 1\"\n";
  expect(head + "cloud { radius \"1 m\" }", "cloud.position");
  expect(head + "cloud { position \"0 0 0\" }", "cloud.radius: expected either a radius");
  expect(head + "cloud { position \"0 0 0\" radius 1 size \"1 1 1\" }",
         "cloud.radius: expected either a radius");
  expect(head + "cloud { position \"0 0 0\" size \"1 1\" }", "cloud.size");
  expect(head + "cloud { position \"0 0 0\" size \"1 0 1\" }", "cloud.size: expected three edges above 0 m");
  expect(head + "cloud { position \"0 0 0\" radius \"1 s\" }", "cloud.radius");
  expect(head + "cloud { position \"0 0 0\" radius 1 extinction 0 }",
         "cloud.extinction: expected a number in");
  expect(head + "cloud { position \"0 0 0\" radius 1 extinction \"1 m\" }", "cloud.extinction");
  expect(head + "cloud { position \"0 0 0\" radius 1 of smoke }", "one of dust droplets");
  expect(head + "cloud { position \"0 0 0\" radius 1 after -1 }", "cloud.after");
  expect(head + "cloud { position \"0 0 0\" radus 1 }", "did you mean cloud.radius?");
  expect(head + "fault { after 3 }", "fault.sensor: missing");
  expect(head + "fault { sensor sonar }", "fault.sensor: expected one of lidar imu");
  expect(head + "fault { sensor lidar kind gone }", "fault.kind: expected one of lost nan");
  expect(head + "fault { sensor imu kind nan }", "fault.kind: expected lost");
  expect(head + "fault { sensor imu after \"1 m\" }", "fault.after");
  expect(head + "fault { sensor imu for -2 }", "fault.for");
  expect("mesh box.ply\nstart \"0 0 1", "line");
  EXPECT_NE(error_for("mesh other.ply\nstart \"0 0 1\"").find("other.ply"), std::string::npos);
}

TEST_F(CaveFiles, ACaveThatIsNotThereIsAnError) {
  EXPECT_NE(error_of([&] { cave::load_cave("/no/such.info", ""); }).find("/no/such.info"), std::string::npos);
  EXPECT_NE(error_of([&] { cave::load_cave("", ""); }), "");
  EXPECT_NE(error_of([&] { cave::load_cave(folder_, "0 0 0"); }), "");
}

}  // namespace
}  // namespace karst::test
