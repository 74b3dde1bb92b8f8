#include "sdk/cave_drawing/run_record.h"

#include <gtest/gtest.h>

#include "tests/unit/cave_drawing/drawn_lines.h"
#include "tests/unit/replay/folder.h"

namespace karst::cave_drawing {
namespace {

TEST(RunRecord, NamesTheCaveThePathTheEntranceAndTheFinds) {
  const test::Folder run;
  run.write("mission.info", "cave\n{\n    file caves/berger.info\n}\n");
  run.write("trajectory.tum", "0 1 2 3 0 0 0 1\n1 2 2 3 0 0 0 1\n");
  run.write("objects.json", R"({"found": [{"number": 1, "what": "helmet", "position": [4, 5, 6]}]})");
  const FlightRecord record = flight_record(run.path());
  EXPECT_EQ(record.name, "berger");
  ASSERT_TRUE(record.entrance);
  EXPECT_EQ(*record.entrance, core::Vec3(1, 2, 3));
  EXPECT_EQ(record.path.size(), 2u);
  ASSERT_EQ(record.finds.size(), 1u);
  EXPECT_EQ(record.finds[0].what, "helmet");
  EXPECT_EQ(record.finds[0].position, core::Vec3(4, 5, 6));
}

TEST(RunRecord, OfAnEmptyFolderHasTheFoldersName) {
  const test::Folder run;
  const FlightRecord record = flight_record(run.path());
  EXPECT_EQ(record.name, run.path().filename().string());
  EXPECT_FALSE(record.entrance);
}

TEST(RunRecord, AFindWithoutAPlaceIsRefused) {
  const test::Folder run;
  for (const char* bad : {R"({"found": [{"position": [1, 2]}]})", R"({"found": [{"position": [1, 2, "x"]}]})",
                          R"({"found": [7]})", "no json"}) {
    run.write("objects.json", bad);
    EXPECT_NE(test::refusal_by([&] { flight_record(run.path()); }).find("objects.json"), std::string::npos)
        << bad;
  }
}

}  // namespace
}  // namespace karst::cave_drawing
