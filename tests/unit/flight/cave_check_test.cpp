#include "sdk/flight/cave_check.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "tests/unit/evaluation/reachable/boxes.h"

namespace karst::flight {
namespace {

/// A file in a folder of this test's own.
std::string own_file(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(KARST_BINARY_DIR) / "test_runs" /
                                       testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

/// Two rooms of 6 x 8 x 3 m, a corridor between them; its vertices changed by `change`.
template <class Change>
std::string written_rooms(const std::string& name, const Change& change) {
  std::set<std::array<int, 3>> cells;
  test::fill(cells, {0, 0, 0}, {6, 8, 3});
  test::fill(cells, {6, 2, 0}, {14, 4, 2});
  test::fill(cells, {14, 0, 0}, {20, 8, 3});
  cave::TriangleMesh mesh = test::lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
  for (core::Vec3f& v : mesh.vertices) v = change(v);
  cave::write_mesh(own_file(name), mesh);
  return own_file(name);
}
std::string written_rooms(const std::string& name) {
  return written_rooms(name, [](const core::Vec3f& v) { return v; });
}

std::string refusal_of(const std::string& cave, const std::string& start, const core::MeshKeys& mesh = {}) {
  try {
    check_cave(cave, start, mesh);
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CaveCheck, ACaveThatCanBeFlownInIsAccepted) {
  EXPECT_EQ(refusal_of(written_rooms("rooms.ply"), "3 3 1"), "");
  EXPECT_TRUE(check_cave(written_rooms("rooms.ply"), "3 3 1").empty());
}

TEST(CaveCheck, AMissingStartIsAnsweredWithOneThatIsAccepted) {
  const std::string cave = written_rooms("rooms.ply"), e = refusal_of(cave, "");
  EXPECT_EQ(e.find(cave + ": start: missing: "), 0u) << e;
  const std::string before = "--start \"";
  const std::size_t at = e.find(before);
  ASSERT_NE(at, std::string::npos) << e;
  const std::string start = e.substr(at + before.size(), e.rfind('"') - at - before.size());
  EXPECT_EQ(refusal_of(cave, start), "") << start;
}

TEST(CaveCheck, AStartInRockIsAnsweredWithOneToo) {
  const std::string e = refusal_of(written_rooms("rooms.ply"), "10 5 1");
  EXPECT_TRUE(contains(e, "start") && contains(e, "a start that suits: --start")) << e;
}

TEST(CaveCheck, MillimetresAreRefusedWithTheUnit) {
  const std::string cave =
      written_rooms("mm.ply", [](const core::Vec3f& v) -> core::Vec3f { return 1000.0f * v; });
  for (const char* start : {"", "3 3 1", "3000 3000 1000"}) {
    const std::string e = refusal_of(cave, start);
    EXPECT_TRUE(contains(e, "(--unit mm)")) << start << ": " << e;
  }
  // The start was named before the cause.
  const std::string first = refusal_of(cave, "");
  EXPECT_EQ(first.find(cave + ": mesh: "), 0u) << first;
  EXPECT_LT(first.find("(--unit mm)"), first.find("then give a start")) << first;
  EXPECT_EQ(refusal_of(cave, "3 3 1", {1, core::MeshUnit::mm, core::UpAxis::z, ""}), "");
}

TEST(CaveCheck, AnotherAxisIsNotedWhereTheFlightCouldGoOn) {
  const std::string cave =
      written_rooms("y_up.ply", [](const core::Vec3f& v) { return core::Vec3f(v.x(), v.z(), -v.y()); });
  // In the first room, which stands on its side.
  const std::vector<std::string> notes = check_cave(cave, "3 1.5 -3");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(contains(notes[0], "likely has y up (--up y)")) << notes[0];
  EXPECT_TRUE(check_cave(cave, "3 3 1", {1, core::MeshUnit::m, core::UpAxis::y, ""}).empty());
}

TEST(CaveCheck, ARemedyForACaveFileIsAKeyOfIt) {
  written_rooms("mm.ply", [](const core::Vec3f& v) -> core::Vec3f { return 1000.0f * v; });
  const std::string info = own_file("mm.info");
  std::ofstream(info) << "mesh mm.ply\n";
  const std::string e = refusal_of(info, "");
  EXPECT_TRUE(contains(e, "(unit mm)")) << e;
}

TEST(CaveCheck, KeysBesideACaveFileAreRefused) {
  written_rooms("rooms.ply");
  const std::string info = own_file("rooms.info");
  std::ofstream(info) << "mesh rooms.ply\nstart \"3 3 1\"\n";
  EXPECT_EQ(refusal_of(info, ""), "");
  EXPECT_TRUE(contains(refusal_of(info, "", {1, core::MeshUnit::mm, core::UpAxis::z, ""}), "is a cave file"));
}

/// An empty folder of this test's own.
std::filesystem::path empty_folder(const std::string& name) {
  std::filesystem::remove_all(own_file(name));
  return own_file(name);
}

TEST(CaveCheck, AGoodCaveIsNotedOnceWithItsNotes) {
  const std::filesystem::path cache = empty_folder("cache");
  const std::string cave =
      written_rooms("y_up.ply", [](const core::Vec3f& v) { return core::Vec3f(v.x(), v.z(), -v.y()); });
  const std::vector<std::string> notes = check_cave(cave, "3 1.5 -3");
  ASSERT_EQ(notes.size(), 1u);
  for (int time = 0; time < 2; ++time) EXPECT_EQ(check_cave(cave, "3 1.5 -3", {}, cache), notes);
  ASSERT_EQ(std::distance(std::filesystem::directory_iterator(cache), {}), 1);
  // What it says is what is noted: it was not looked at again.
  const std::string noted = std::filesystem::directory_iterator(cache)->path().string();
  std::ofstream(noted) << "another note\ncan be flown\n";
  EXPECT_EQ(check_cave(cave, "3 1.5 -3", {}, cache), std::vector<std::string>{"another note"});
  // A file that was cut off says nothing.
  std::ofstream(noted) << "another note\ncan be";
  EXPECT_EQ(check_cave(cave, "3 1.5 -3", {}, cache), notes);
}

TEST(CaveCheck, WhatIsOtherThanNotedIsLookedAt) {
  const std::filesystem::path cache = empty_folder("cache");
  const std::string mesh = written_rooms("rooms.ply"), info = own_file("rooms.info");
  std::ofstream(info) << "mesh rooms.ply\nstart \"3 3 1\"\n";
  EXPECT_TRUE(check_cave(info, "", {}, cache).empty());
  const auto refused = [&](const std::string& start) {
    try {
      check_cave(info, start, {}, cache);
      return false;
    } catch (const core::InputError&) {
      return true;
    }
  };
  EXPECT_FALSE(refused(""));
  EXPECT_TRUE(refused("10 1 1")) << "a start in rock";
  EXPECT_TRUE(refused("10 1 1")) << "what is refused is not noted";
  written_rooms("rooms.ply", [](const core::Vec3f& v) -> core::Vec3f { return 1000.0f * v; });
  EXPECT_TRUE(refused("")) << "another mesh";
  written_rooms("rooms.ply");
  EXPECT_FALSE(refused(""));
  std::ofstream(info) << "mesh rooms.ply\nstart \"3 3 1\"\nunit mm\n";
  EXPECT_TRUE(refused("")) << "another frame";
}

}  // namespace
}  // namespace karst::flight
