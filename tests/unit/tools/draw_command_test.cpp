// `karst draw` as a command: what it writes, says and refuses.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/tools/draw_command.h"
#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/replay/folder.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

class DrawCommand : public testing::Test {
 protected:
  /// What the command writes to standard output.
  std::string draw(std::vector<std::string> words) const {
    CLI::App app{"karst", "karst"};
    add_draw_command(app);
    words.insert(words.begin(), "draw");
    std::reverse(words.begin(), words.end());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      app.parse(words);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      testing::internal::GetCapturedStderr();
      throw;
    }
    testing::internal::GetCapturedStderr();
    return testing::internal::GetCapturedStdout();
  }
  std::string refusal(const std::vector<std::string>& words) const {
    try {
      draw(words);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  }
  /// A run with a tunnel of 40 m.
  void fly() const {
    core::write_octomap(test::map_of_boxes({{{0, 0, 0}, {199, 14, 14}}}), (folder_.path() / "map").string());
    folder_.write("mission.info", "cave\n{\n    file caves/berger.info\n}\n");
    folder_.write("trajectory.tum", "0 1.5 1.5 0.5 0 0 0 1\n1 30 1.5 1.5 0 0 0 1\n");
  }
  std::string content(const std::string& name) const {
    std::ifstream in(folder_.path() / name);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  std::string run() const { return folder_.path().string(); }
  std::string out() const { return (folder_.path() / "drawings" / "berger").string(); }

  test::Folder folder_;
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(DrawCommand, WritesThreeDrawingsOfARunAndNamesThem) {
  fly();
  const std::string said = draw({run(), "--out", out(), "--date", "spring 2026"});
  for (const char* view : {"plan", "extended", "projected"}) {
    const std::string file = std::string("drawings/berger.") + view + ".svg";
    EXPECT_TRUE(has(said, file)) << said;
    EXPECT_TRUE(has(content(file), ">berger<"));
    EXPECT_TRUE(has(content(file), "spring 2026"));
    EXPECT_TRUE(has(content(file), "explored by karst"));
  }
  EXPECT_TRUE(has(content("drawings/berger.plan.svg"), "class=\"path\""));
}

TEST_F(DrawCommand, AMapAloneIsDrawnWithTheEntranceThatIsNamed) {
  fly();
  draw({run() + "/map.bt", "--out", out(), "--entrance", "1 1 1", "--name", "Gouffre"});
  EXPECT_TRUE(has(content("drawings/berger.plan.svg"), ">Gouffre<"));
  EXPECT_TRUE(has(content("drawings/berger.plan.svg"), ">entrance<"));
  EXPECT_TRUE(has(content("drawings/berger.plan.svg"), "from a map"));
}

TEST_F(DrawCommand, ScaleAndPaperAreAsAsked) {
  fly();
  draw({run(), "--out", out(), "--paper", "a3", "--scale", "1:1000"});
  EXPECT_TRUE(has(content("drawings/berger.plan.svg"), "width=\"420mm\""));
  EXPECT_TRUE(has(content("drawings/berger.plan.svg"), ">1:1000<"));
  EXPECT_TRUE(has(refusal({run(), "--out", out() + "2", "--scale", "1:20"}), "does not fit on a4 at 1:20"));
  EXPECT_FALSE(fs::exists(out() + "2.plan.svg"));
  for (const char* bad : {"1:0", "one", "1:5x", "nan", "-500"})
    EXPECT_TRUE(has(refusal({run(), "--out", out(), "--force", "--scale=" + std::string(bad)}), "--scale"))
        << bad;
}

TEST_F(DrawCommand, OverwritesOnlyWhenForced) {
  fly();
  draw({run(), "--out", out()});
  EXPECT_TRUE(has(refusal({run(), "--out", out()}), "is there already; --force overwrites it"));
  EXPECT_EQ(refusal({run(), "--out", out(), "--force"}), "");
}

TEST_F(DrawCommand, ACaveOfOneCellInWidthIsRefusedAndNothingIsWritten) {
  core::write_octomap(test::map_of_boxes({{{0, 0, 0}, {199, 0, 0}}}), (folder_.path() / "map").string());
  EXPECT_TRUE(has(refusal({run(), "--out", out()}), "no passage is wide enough to be drawn"));
  EXPECT_FALSE(fs::exists(folder_.path() / "drawings"));
}

TEST_F(DrawCommand, WhatCannotBeDrawnIsNamed) {
  EXPECT_TRUE(has(refusal({run(), "--out", out()}), "holds no map.bt"));
  folder_.write("team.jsonl", "{}\n");
  EXPECT_TRUE(has(refusal({run(), "--out", out()}), "robot_1"));
  EXPECT_TRUE(has(refusal({folder_.write("bad.bt", "no map"), "--out", out()}), "bad.bt"));
  EXPECT_TRUE(has(refusal({run() + "/map.bt", "--out", out(), "--entrance", "1 2"}), "--entrance"));
  EXPECT_FALSE(refusal({run(), "--out", out(), "--bearing", "nan"}).empty());
  for (const char* name : {"cave.ply", "no_such_run"}) {
    const std::string said = refusal({name, "--out", out()});
    for (const char* part : {name, "run directory", ".bt, .ot", ".svx"}) EXPECT_TRUE(has(said, part)) << said;
  }
}

}  // namespace
}  // namespace karst::tools
