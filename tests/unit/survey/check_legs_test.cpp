// What cavern says and does is passed on and checked, with a cavern that says and does more than the real
// one.
#include "sdk/survey/check_legs.h"

#include "tests/unit/survey/adjusted_surveys.h"
#include "tests/unit/survey/fake_cavern.h"

namespace karst::survey {
namespace {

using test::adjusted_lines;
using test::adjustment_refusal;
using test::FakeCavern;
using test::kNormal;
using test::notes_say;
using test::says;

const char* const kTenIsEleven = "sed -i 's/ 10\\.000000 / 11.000000 /' \"$file\"";

TEST(CheckLegs, ALegThatCavernMisplacesIsRefusedWithItsLine) {
  SKIP_WITHOUT_SURVEX();
  const std::string lines = kNormal + "1 2 5 0 0\n2 3 10 0 0\n";
  EXPECT_EQ(adjustment_refusal(lines), "");
  const FakeCavern fake(kTenIsEleven);
  EXPECT_TRUE(says(adjustment_refusal(lines),
                   "s.th: line 5: cavern puts the end of this leg 1.00 m from where its reading"))
      << adjustment_refusal(lines);
}

TEST(CheckLegs, LegsOfLoopsMayMove) {
  SKIP_WITHOUT_SURVEX();
  const FakeCavern fake(kTenIsEleven);
  EXPECT_EQ(
      adjustment_refusal(kNormal + "1 2 10 0 0\n2 3 12 90 0\n3 4 10 180 0\n4 1 12.3 270 0\n4 5 7 0 0\n"), "");
}

// cavern 1.4.4 puts the end of a vertical dive without a compass reading kilometres down.
TEST(CheckLegs, ADiveThatEndsKilometresDownIsRefused) {
  SKIP_WITHOUT_SURVEX();
  const std::string lines =
      "data diving from to length compass depthchange\n1 2 10 - -10\n" + kNormal + "2 3 5 0 0\n";
  EXPECT_EQ(adjustment_refusal(lines), "");
  const FakeCavern fake("sed -i 's/ 10\\.000000 0\\.000000000 / 10.000000 - /' \"$file\"");
  const std::string said = adjustment_refusal(lines);
  if (said.empty()) GTEST_SKIP() << "skipped: this cavern places vertical dives";
  EXPECT_TRUE(says(said, "s.th: line 4: cavern puts the end of this leg 5990.00 m")) << said;
}

TEST(CheckLegs, ADiveDeeperThanItsTapeIsLongIsNotedWithWhereItEnds) {
  SKIP_WITHOUT_SURVEX();
  const Survey s =
      adjusted_lines("data diving from to length compass depthchange\n1 2 10 90 -12\n2 3 10 90 -6\n");
  const double depth_m = -test::place(s, "s.2").z();
  ASSERT_GT(depth_m, 10);
  ASSERT_LT(depth_m, 12);
  const auto note = std::find_if(s.notes.begin(), s.notes.end(), [](const Note& n) {
    return says(n.text, "between tape and depth, the end of the leg is");
  });
  ASSERT_NE(note, s.notes.end());
  EXPECT_EQ(note->source.line, 4u);
  EXPECT_EQ(note->more, 0u);
  EXPECT_TRUE(notes_say(s.notes, "cavern: Tape reading is less than change in depth"));
}

TEST(CheckLegs, WhatCavernWarnsOfIsNotedWithTheLineOfTheSurvey) {
  SKIP_WITHOUT_SURVEX();
  const FakeCavern fake(
      "n=$(grep -n -e '^[*]fix f1' -e ' 10\\.000000 ' \"$file\" | cut -d: -f1 | head -1)\n"
      "echo \"$file:$n: warning: it rains in $(basename $file)\"");
  const Survey s =
      adjusted_lines("cs UTM33\nfix 1 400000 5000000 0\nfix 9 400100 5000000 0\ndate 2010.05.03\n" + kNormal +
                     "1 2 10 0 0\n2 3 7 0 0\n9 8 7 0 0\n");
  const auto line_of = [&](const std::string& text) {
    for (const Note& n : s.notes)
      if (n.text == text) return std::pair(n.source.line, n.more);
    return std::pair(0u, std::size_t{99});
  };
  EXPECT_EQ(line_of("cavern: it rains in readings.svx"), std::pair(8u, std::size_t{0}));
  EXPECT_EQ(line_of("cavern: it rains in probe.svx"), std::pair(5u, std::size_t{0}))
      << "though it is asked twice";
  EXPECT_FALSE(notes_say(s.notes, "No survey date")) << "of a leg that karst itself asks for";
}

}  // namespace
}  // namespace karst::survey
