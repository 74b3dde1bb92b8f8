// `karst map merge` of a karst that was built without PCL.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "sdk/map_merge/icp.h"
#include "sdk/tools/map_command.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::tools {
namespace {

TEST(MapMergeWithoutPcl, SaysWhatToInstallBeforeItReadsOrWritesAnything) {
  ASSERT_FALSE(map_merge::has_icp()) << "icp_missing.cpp is not what was linked";
  test::TemporaryDirectory dir;
  const std::filesystem::path out = dir.path() / "made" / "both";
  CLI::App app;
  add_map_command(app);
  std::vector<std::string> words{"map", "merge", "/nowhere/a.bt", "/nowhere/b.bt", "--out", out.string()};
  std::reverse(words.begin(), words.end());
  std::string said;
  try {
    app.parse(words);
  } catch (const std::runtime_error& e) {
    said = e.what();
  }
  EXPECT_EQ(said, "this karst was built without PCL: apt-get install libpcl-dev and build again");
  EXPECT_FALSE(std::filesystem::exists(out.parent_path()));
}

}  // namespace
}  // namespace karst::tools
