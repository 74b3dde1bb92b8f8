#include "sdk/tools/cave_command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/selection/cave_facts.h"
#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/tools/captured_output.h"

namespace {

namespace fs = std::filesystem;
using karst::core::InputError;

karst::test::CapturedOutput run_both(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  app.require_subcommand(1);
  karst::tools::add_cave_command(app);
  return karst::test::captured_output(app, std::move(words));
}

/// What the command writes to standard output.
std::string run(std::vector<std::string> words) { return run_both(std::move(words)).out; }

fs::path fresh_folder() {
  const fs::path folder =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

const std::vector<std::string> kQuick{"--set", "volume=500", "--set", "grid=0.4 m"};

std::vector<std::string> with(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(CaveCommand, WhatGenerateWritesCanBeFlownAndMeasured) {
  const fs::path folder = fresh_folder();
  const std::string stem = (folder / "new" / "demo").string();
  const std::string said = run(with({"cave", "generate", "--seed", "3", "--out", stem}, kQuick));
  EXPECT_NE(said.find("karst fly --cave " + stem + ".info"), std::string::npos) << said;
  const karst::cave::Cave cave = karst::cave::load_cave(stem + ".info", "");
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", stem + ".info"}));
  EXPECT_EQ(j["triangles"], cave.scene.mesh().triangles.size());
  EXPECT_TRUE(j["closed"]);
  EXPECT_GE(j["start_clearance_m"], 1.0);
  EXPECT_GT(j["fly_through_volume_m3"], 100);
  EXPECT_LE(j["fly_through_volume_m3"], j["reachable_volume_m3"]);
  EXPECT_LE(j["reachable_volume_m3"], j["free_volume_m3"]);
  EXPECT_LE(j["free_volume_m3"], 500 * 1.15);
  const std::string text = run({"cave", "info", stem + ".info"});
  EXPECT_NE(text.find("closed             yes"), std::string::npos) << text;
}

TEST(CaveCommand, BareMeshWithoutStartStillTellsItsShape) {
  std::set<std::array<int, 3>> cells;
  karst::test::fill(cells, {0, 0, 0}, {4, 3, 3});
  auto mesh = karst::test::lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
  const std::string path = (fresh_folder() / "box.ply").string();
  karst::cave::write_mesh(path, mesh);
  const auto bare = nlohmann::json::parse(run({"cave", "info", "--json", path}));
  EXPECT_EQ(bare["triangles"], 2 * 2 * (4 * 3 + 4 * 3 + 3 * 3));
  EXPECT_TRUE(bare["closed"]);
  EXPECT_FALSE(bare.contains("reachable_volume_m3"));
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", "--start", "2 1.5 1.5", path}));
  EXPECT_NEAR(j["start_clearance_m"].get<double>(), 1.45, 0.01);
  EXPECT_NEAR(j["width_m_p10_p50_p90"][1].get<double>(), 3.0, 0.01);
  EXPECT_NEAR(j["height_m_p10_p50_p90"][1].get<double>(), 3.0, 0.01);
}

/// Why the command fails.
std::string reason(std::vector<std::string> words) {
  try {
    run(std::move(words));
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// A room of 8 x 5 x 3 m and a corridor that leads east from it, closed or with an open end.
karst::cave::TriangleMesh room_with_corridor(bool open) {
  std::set<std::array<int, 3>> cells;
  karst::test::fill(cells, {0, 0, 0}, {8, 5, 3});
  karst::test::fill(cells, {8, 1, 0}, {16, 3, 2});
  auto mesh = karst::test::lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
  if (open)
    std::erase_if(mesh.triangles, [&](const auto& t) {
      return mesh.vertices[t[0]].x() > 16 && mesh.vertices[t[1]].x() > 16 && mesh.vertices[t[2]].x() > 16;
    });
  return mesh;
}

TEST(CaveCommand, WithoutAStartOneIsProposedThatInfoAccepts) {
  const fs::path folder = fresh_folder();
  const std::string mesh = (folder / "room.ply").string(), info = (folder / "room.info").string();
  karst::cave::write_mesh(mesh, room_with_corridor(false));
  std::ofstream(info) << "mesh room.ply\n";
  for (const std::string& file : {mesh, info}) {
    const auto bare = nlohmann::json::parse(run({"cave", "info", "--json", file}));
    ASSERT_TRUE(bare["proposed_start"].is_string()) << file;
    const std::string start = bare["proposed_start"];
    const auto j = nlohmann::json::parse(run({"cave", "info", "--json", "--start", start, file}));
    EXPECT_GE(j["start_clearance_m"], 0.7);
    EXPECT_GT(j["fly_through_volume_m3"], 10);
    const std::string text = run({"cave", "info", file});
    EXPECT_NE(text.find("--start \"" + start + "\""), std::string::npos) << text;
  }
}

TEST(CaveCommand, ARefusedStartIsAnsweredWithOneThatSuits) {
  const std::string mesh = (fresh_folder() / "room.ply").string();
  karst::cave::write_mesh(mesh, room_with_corridor(false));
  const std::string e = reason({"cave", "info", mesh, "--start", "4 2 9"});
  EXPECT_NE(e.find("room.ply: start 4.0 2.0 9.0: outside the mesh; a start that suits: --start \""),
            std::string::npos)
      << e;
}

TEST(CaveCommand, UnitAndAxisAreAdvisedAndApplied) {
  const fs::path folder = fresh_folder();
  auto mesh = room_with_corridor(false);
  for (auto& v : mesh.vertices) v = 1000.0f * karst::core::Vec3f(v.x(), v.z(), -v.y());
  const std::string file = (folder / "mm.ply").string();
  karst::cave::write_mesh(file, mesh);
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", file}));
  ASSERT_FALSE(j["advice"].empty());
  EXPECT_EQ(j["advice"][0]["remedy"], "unit mm");
  EXPECT_TRUE(j["proposed_start"].is_null()) << "it would be a place in a wrong frame";
  EXPECT_NE(run({"cave", "info", file}).find(": --unit mm\n"), std::string::npos);
  const std::vector<std::string> right{"--unit", "mm", "--up", "y", "--json"};
  const auto fine = nlohmann::json::parse(run(with({"cave", "info", file}, right)));
  EXPECT_TRUE(fine["advice"].empty()) << fine["advice"].dump();
  ASSERT_TRUE(fine["proposed_start"].is_string());
  const std::string start = fine["proposed_start"];
  const auto flat = nlohmann::json::parse(run(with({"cave", "info", file, "--start", start}, right)));
  // The same as of the mesh that was never turned.
  const std::string plain = (folder / "plain.ply").string();
  karst::cave::write_mesh(plain, room_with_corridor(false));
  const auto same = nlohmann::json::parse(run({"cave", "info", plain, "--start", "4 2 1.2", "--json"}));
  EXPECT_NEAR(flat["reachable_volume_m3"].get<double>(), same["reachable_volume_m3"].get<double>(), 0.3);
}

TEST(CaveCommand, CapClosesAHoleAndSaysWhatItClosed) {
  const fs::path folder = fresh_folder();
  const std::string mesh = (folder / "open.ply").string(), closed = (folder / "closed.ply").string();
  karst::cave::write_mesh(mesh, room_with_corridor(true));
  const std::string e = reason({"cave", "info", mesh, "--start", "4 2 1.2"});
  EXPECT_NE(e.find("free space leads outside the mesh near 1"), std::string::npos) << e;
  EXPECT_NE(e.find("a loop of 8, 2.8 m across, 4 m², around 16.0 2.0 1."), std::string::npos) << e;
  const std::string said = run({"cave", "info", mesh, "--cap", closed});
  EXPECT_NE(said.find("1 loop of open edges, 1 closed"), std::string::npos) << said;
  EXPECT_NE(said.find("4.00 m²,   2.83 m across"), std::string::npos) << said;
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", closed, "--start", "4 2 1.2"}));
  EXPECT_TRUE(j["closed"]);
  EXPECT_EQ(j["open_loops"], 0);
  EXPECT_NE(reason({"cave", "info", mesh, "--cap", closed}).find("is there already"), std::string::npos);
  const std::string other = (folder / "other.ply").string();
  EXPECT_NE(reason({"cave", "info", mesh, "--cap", other, "--cap-limit", "2"}).find("no hole was closed"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "info", closed, "--cap", other}).find("nothing to close"), std::string::npos);
  EXPECT_NE(reason({"cave", "info", mesh, "--cap", (folder / "x.obj").string()}).find(".ply or .stl"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(other));
}

TEST(CaveCommand, AnOpenMeshIsSaidToBeOpenAndItsStartToHoldAfterCapping) {
  const fs::path folder = fresh_folder();
  const std::string mesh = (folder / "open.ply").string(), closed = (folder / "closed.ply").string();
  karst::cave::write_mesh(mesh, room_with_corridor(true));
  const std::string said = run({"cave", "info", mesh});
  for (const char* part : {"open edges         1 loop; `karst cave info CAVE --cap OUT.ply` closes holes\n",
                           "2.8 m across, 4 m², around 16.0 2.0 1.", "valid only after capping: --start \"",
                           "until then it is refused: ", "hole"})
    EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
  EXPECT_EQ(said.find("one that suits"), std::string::npos) << said;
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", mesh}));
  ASSERT_EQ(j["open_edges"].size(), 1u);
  EXPECT_NEAR(j["open_edges"][0]["area_m2"].get<double>(), 4, 0.01);
  EXPECT_TRUE(j["proposed_start_refused"].is_string());
  run({"cave", "info", mesh, "--cap", closed});
  const std::string start = j["proposed_start"];
  const auto capped = nlohmann::json::parse(run({"cave", "info", "--json", closed, "--start", start}));
  EXPECT_GE(capped["start_clearance_m"].get<double>(), 0.7);
  const auto whole = nlohmann::json::parse(run({"cave", "info", "--json", closed}));
  EXPECT_TRUE(whole["proposed_start_refused"].is_null());
  EXPECT_TRUE(whole["open_edges"].empty());
}

TEST(CaveCommand, TheSizeIsPrintedWithTheUnitItWasReadIn) {
  const fs::path folder = fresh_folder();
  const std::string mesh = (folder / "room.ply").string(), info = (folder / "room.info").string();
  karst::cave::write_mesh(mesh, room_with_corridor(false));
  std::ofstream(info) << "mesh room.ply\n";
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  };
  says(run({"cave", "info", mesh}), "16.0 x 5.0 x 3.0 m (unit: m; --unit changes it), heights ");
  says(run({"cave", "info", mesh, "--unit", "ft"}), "4.9 x 1.5 x 0.9 m (unit: ft; --unit changes it)");
  says(run({"cave", "info", mesh, "--unit", "in"}), "(unit: in; --unit changes it)");
  says(run({"cave", "info", info}), "(unit: m; the key unit changes it)");
}

TEST(CaveCommand, AnAxisThatTheShapeDoesNotTellIsHintedAtUntilItIsGiven) {
  const fs::path folder = fresh_folder();
  std::set<std::array<int, 3>> cells;
  karst::test::fill(cells, {0, 0, -4}, {20, 4, 0});
  const std::string mesh = (folder / "tunnel.ply").string();
  karst::cave::write_mesh(mesh, karst::test::lattice_mesh(cells, 1.0, {0, 0, 0}));
  const std::string said = run({"cave", "info", mesh});
  EXPECT_NE(said.find("if y is up in this file, pass --up y"), std::string::npos) << said;
  EXPECT_NE(said.find("heights -4.0 to 0.0 m"), std::string::npos) << said;
  EXPECT_NE(said.find("one that suits: --start"), std::string::npos) << "a hint only: " << said;
  for (const char* up : {"y", "z"})
    EXPECT_EQ(run({"cave", "info", mesh, "--up", up}).find("  hint  "), std::string::npos) << up;
}

TEST(CaveCommand, BadMeshOptionsNameTheReason) {
  const std::string mesh = (fresh_folder() / "room.ply").string();
  karst::cave::write_mesh(mesh, room_with_corridor(false));
  const auto refused = [&](const std::string& option, const std::string& value) {
    return reason({"cave", "info", mesh, option, value});
  };
  EXPECT_NE(refused("--unit", "furlong").find("command line: unit: expected one of m cm mm ft"),
            std::string::npos);
  const std::string km = refused("--unit", "km");
  EXPECT_NE(km.find("expected one of m cm mm ft in, got \"km\""), std::string::npos) << km;
  EXPECT_EQ(km.find("did you mean"), std::string::npos) << "a factor of 1000: " << km;
  EXPECT_NE(refused("--scale", "0").find("command line: scale: expected a number in"), std::string::npos);
  EXPECT_NE(refused("--scale", "nan").find("command line: scale: expected a number in"), std::string::npos);
  EXPECT_NE(refused("--up", "x").find("command line: up: expected one of z y"), std::string::npos);
  EXPECT_NE(refused("--offset", "1 2").find("offset: expected three numbers"), std::string::npos);
}

TEST(CaveCommand, BadArgumentsNameTheReason) {
  const fs::path folder = fresh_folder();
  const std::string out = (folder / "c").string();
  EXPECT_NE(reason({"cave", "generate", "--preset", "larg", "--out", out}).find("did you mean large?"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "generate", "--set", "volum=900", "--out", out}).find("did you mean volume?"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "generate", "--set", "volume", "--out", out}).find("expected key=value"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "generate", "--set", "volume=1", "--out", out}).find("expected a number in 300"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "generate", "--out", folder.string() + "/"}).find("without ending"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "info", (folder / "none.ply").string()}).find("none.ply: no such file"),
            std::string::npos);
  EXPECT_NE(reason({"cave", "info", (folder / "none.info").string()}).find("`karst cave generate` makes one"),
            std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder));
  std::ofstream(folder / "file") << "x";
  EXPECT_NE(reason(with({"cave", "generate", "--out", (folder / "file" / "c").string()}, kQuick))
                .find("cannot be made"),
            std::string::npos);
}

TEST(MeshFacts, CountsEdgesOfAHoleAndOfAFlippedTriangle) {
  std::set<std::array<int, 3>> cells{{0, 0, 0}};
  auto mesh = karst::test::lattice_mesh(cells, 1.0, {0, 0, 0});
  EXPECT_EQ(karst::selection::mesh_facts(mesh).edges, 18u);
  EXPECT_EQ(karst::selection::mesh_facts(mesh).odd_edges, 0u);
  auto open = mesh;
  open.triangles.pop_back();
  EXPECT_EQ(karst::selection::mesh_facts(open).odd_edges, 3u);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_EQ(karst::selection::mesh_facts(mesh).odd_edges, 0u) << "it is as closed as before";
  EXPECT_EQ(karst::selection::mesh_facts(mesh).flipped_edges, 3u);
}

TEST(MeshFacts, AnEdgeOfFourTrianglesIsOddAndNotFlipped) {
  // Two cubes that touch along an edge.
  std::set<std::array<int, 3>> cells{{0, 0, 0}, {1, 1, 0}};
  const auto mesh = karst::test::lattice_mesh(cells, 1.0, {0, 0, 0});
  EXPECT_EQ(karst::selection::mesh_facts(mesh).odd_edges, 1u);
  EXPECT_EQ(karst::selection::mesh_facts(mesh).flipped_edges, 0u);
}

// It was called open: the simulator looks at triangles from both sides.
TEST(CaveCommand, AMeshWithATriangleTheOtherWayRoundIsClosed) {
  const std::string path = (fresh_folder() / "room.ply").string();
  auto mesh = room_with_corridor(false);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  karst::cave::write_mesh(path, mesh);
  const std::string text = run({"cave", "info", path});
  EXPECT_NE(text.find("closed             yes (3 edges join triangles that face opposite sides; harmless)\n"),
            std::string::npos)
      << text;
  const auto j = nlohmann::json::parse(run({"cave", "info", "--json", path}));
  EXPECT_TRUE(j["closed"]);
  EXPECT_EQ(j["odd_edges"], 0);
  EXPECT_EQ(j["flipped_edges"], 3);

  mesh = room_with_corridor(true);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  karst::cave::write_mesh(path, mesh);
  const std::string open = run({"cave", "info", path});
  EXPECT_NE(open.find("edges do not join two triangles (3 edges join"), std::string::npos) << open;
  EXPECT_NE(open.find("closed             no, 8 of "), std::string::npos) << open;
}

TEST(CaveCommand, APointCloudIsSentToFromCloud) {
  const std::string path = (fresh_folder() / "cloud.ply").string();
  std::ofstream(path) << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                         "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string e = reason({"cave", "info", path});
  EXPECT_NE(e.find("a point cloud? `karst cave from-cloud` makes a cave of it"), std::string::npos) << e;
}

TEST(CaveCommand, GenerateWithQuietPrintsNothing) {
  const std::string stem = (fresh_folder() / "demo").string();
  const auto [out, err] = run_both(with({"cave", "generate", "--quiet", "--out", stem}, kQuick));
  EXPECT_EQ(out + err, "");
  EXPECT_TRUE(fs::exists(stem + ".info") && fs::exists(stem + ".ply"));
}

}  // namespace
