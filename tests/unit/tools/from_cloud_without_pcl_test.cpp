// `karst cave from-cloud` of a karst that was built without PCL.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "sdk/cave_from_cloud/poisson.h"
#include "sdk/tools/cave_command.h"
#include "sdk/tools/from_cloud_command.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::tools {
namespace {

TEST(FromCloudWithoutPcl, SaysWhatToInstallBeforeItReadsOrWritesAnything) {
  ASSERT_FALSE(from_cloud::has_poisson()) << "poisson_missing.cpp is not what was linked";
  test::TemporaryDirectory dir;
  const std::filesystem::path out = dir.path() / "made" / "cave";
  CLI::App app;
  add_from_cloud_command(add_cave_command(app));
  std::vector<std::string> words{"cave", "from-cloud", "/nowhere/scan.las", "--out", out.string()};
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
