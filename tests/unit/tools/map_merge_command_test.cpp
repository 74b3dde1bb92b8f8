// `karst map merge` as a command: what it writes, what it refuses, and that a refusal leaves nothing behind.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/map_merge/merge_maps.h"
#include "sdk/tools/map_command.h"
#include "tests/unit/evaluation/fake_run.h"
#include "tests/unit/map_merge/tunnels.h"

namespace karst::tools {
namespace {

using core::Vec3;
using nlohmann::json;
using test::TemporaryDirectory;
using test::Tunnel;

/// The exit code; errors of input are thrown.
int run(std::vector<std::string> words) {
  CLI::App app;
  add_map_command(app);
  std::reverse(words.begin(), words.end());
  try {
    app.parse(words);
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  }
  return 0;
}

json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return json::parse(in, nullptr, false);
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(MapMerge, WritesTheUnionOrNothingAtAll) {
  TemporaryDirectory in, out;
  const auto name = [&](const char* n) { return (in.path() / n).string(); };
  const Tunnel tunnel{.phase = 0.4};
  const core::VoxelMap first = tunnel.map(0, 30);
  core::write_octomap(first, name("a"));
  core::VoxelMap moved{core::MapOptions{}};
  map_merge::add_map(moved, tunnel.map(14, 44), {Vec3(9, 4, -2), core::from_heading(1)}, {});
  core::write_octomap(moved, name("b"));
  core::write_octomap(Tunnel{.phase = 2.0}.map(0, 30), name("other"));

  EXPECT_EQ(run({"map", "merge", name("a.ot"), name("other.ot"), "--out", (out.path() / "m").string()}), 2);
  EXPECT_EQ(files_in(out.path()), 0u);
  EXPECT_EQ(run({"map", "merge", name("a.ot"), name("b.ot"), "--out", (out.path() / "m").string()}), 0);
  EXPECT_EQ(files_in(out.path()), 4u);
  EXPECT_TRUE(read_json(out.path() / "m.json")["maps"][0]["trusted"]);
  const core::VoxelMap merged = core::read_octomap((out.path() / "m.ot").string());
  const double whole = tunnel.map(0, 44).free_volume_m3();
  EXPECT_NEAR(merged.free_volume_m3(), whole, 0.05 * whole);
  EXPECT_THROW(run({"map", "merge", name("a.ot"), name("b.ot"), "--out", (out.path() / "m.bt").string()}),
               core::InputError)
      << "what is there is not overwritten";
}

TEST(MapMerge, CellsOfAnotherSizeAreAnError) {
  TemporaryDirectory dir;
  for (const auto& [name, cell] : {std::pair{"a", 0.2}, {"b", 0.3}}) {
    core::VoxelMap map(core::MapOptions{.resolution_m = cell});
    map.assign({0, 0, 0}, 4, 1.0f);
    core::write_octomap(map, (dir.path() / name).string());
  }
  EXPECT_THROW(run({"map", "merge", (dir.path() / "a.bt").string(), (dir.path() / "b.bt").string(), "--out",
                    (dir.path() / "m").string()}),
               core::InputError);
  EXPECT_THROW(run({"map", "merge", (dir.path() / "a.bt").string(), "/nowhere.bt", "--out",
                    (dir.path() / "m").string()}),
               core::InputError);
}

}  // namespace
}  // namespace karst::tools
