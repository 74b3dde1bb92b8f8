#include "sdk/tools/cave_command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/selection/cave_facts.h"
#include "tests/unit/evaluation/reachable/boxes.h"

namespace {

namespace fs = std::filesystem;
using karst::core::InputError;

/// What the command writes to standard output.
std::string run(std::vector<std::string> words) {
  CLI::App app{"karst", "karst"};
  app.require_subcommand(1);
  karst::tools::add_cave_command(app);
  std::reverse(words.begin(), words.end());
  testing::internal::CaptureStdout();
  try {
    app.parse(words);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  return testing::internal::GetCapturedStdout();
}

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

TEST(CaveCommand, BadArgumentsNameTheReason) {
  const fs::path folder = fresh_folder();
  const std::string out = (folder / "c").string();
  const auto reason = [](std::vector<std::string> words) -> std::string {
    try {
      run(std::move(words));
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
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
  EXPECT_NE(reason({"cave", "info", (folder / "none.ply").string()}).find("no such cave file"),
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
  EXPECT_EQ(karst::selection::mesh_facts(mesh).odd_edges, 3u);
}

}  // namespace
