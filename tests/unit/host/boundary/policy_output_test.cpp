// What a policy's process prints: lines whatever their pieces, bounded, and harmless to a terminal.
#include "sdk/host/boundary/policy_output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/closed_loop/command.h"

namespace karst::test {
namespace {

using host::PolicyOutput;

TEST(PolicyOutput, KeepsLinesWhateverTheirPiecesAndThoseOfBeforeThereWasAFile) {
  const std::filesystem::path file = fresh_folder("policy_output_lines") / "printed.txt";
  PolicyOutput output;
  EXPECT_TRUE(output.empty());
  output.add("before there is a file\nin ");
  EXPECT_FALSE(output.empty());
  output.write_to(file);
  output.add("pieces\n\nnot ended");
  EXPECT_EQ(bytes_of(file), "before there is a file\nin pieces\n\n") << "at once, and whole lines only";
  output.end_line();
  output.end_line();
  EXPECT_EQ(bytes_of(file), "before there is a file\nin pieces\n\nnot ended\n");
  EXPECT_EQ(output.last_lines(), bytes_of(file));
  EXPECT_EQ(output.problem(), "");
}

TEST(PolicyOutput, OfNothingThereIsNoFile) {
  const std::filesystem::path file = fresh_folder("policy_output_nothing") / "printed.txt";
  PolicyOutput output;
  output.write_to(file);
  output.add("");
  output.end_line();
  EXPECT_TRUE(output.empty());
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(output.problem(), "");
}

TEST(PolicyOutput, HoldsNothingThatATerminalObeys) {
  const std::filesystem::path file = fresh_folder("policy_output_escapes") / "printed.txt";
  PolicyOutput output;
  output.write_to(file);
  output.add("\x1b[2J\x1b]0;title\x07gone\rover \xff\tend\n");
  EXPECT_EQ(bytes_of(file), "?[2J?]0;title?gone?over ?\tend\n");
  EXPECT_EQ(output.last_lines(), bytes_of(file));
}

TEST(PolicyOutput, AFloodIsCutOnceAndItsLastLinesAreAtHand) {
  const std::filesystem::path file = fresh_folder("policy_output_flood") / "printed.txt";
  PolicyOutput output;
  output.write_to(file);
  const std::string rest = " " + std::string(99, 'x') + "\n";
  for (int i = 10'000; i < 40'000; ++i) output.add(std::to_string(i) + rest);
  const std::string text = bytes_of(file);
  EXPECT_GT(text.size(), host::kOutputBudget_bytes - 200);
  EXPECT_LT(text.size(), host::kOutputBudget_bytes + 100);
  EXPECT_TRUE(text.ends_with("[karst: the rest is left out: of a policy's output a flight keeps 1 MiB]\n"));
  EXPECT_EQ(text.find("[karst:"), text.rfind("[karst:"));
  EXPECT_TRUE(output.last_lines().starts_with("39990 x")) << output.last_lines();
  EXPECT_TRUE(output.last_lines().ends_with(std::to_string(39'999) + rest));
}

TEST(PolicyOutput, ALineWithoutEndIsBroken) {
  const std::filesystem::path file = fresh_folder("policy_output_long") / "printed.txt";
  PolicyOutput output;
  output.write_to(file);
  output.add(std::string(10'000, 'y'));
  output.end_line();
  const std::string piece(4096, 'y');
  EXPECT_EQ(bytes_of(file), piece + "\n" + piece + "\n" + std::string(10'000 - 2 * 4096, 'y') + "\n");
  EXPECT_EQ(output.last_lines().size(), 3u * 201) << "and short on the screen";
}

TEST(PolicyOutput, TheLinesBeforeTheLastBreakAreKept) {
  PolicyOutput output;
  output.note_break();
  EXPECT_EQ(output.before_break(), "");
  output.add("first\n");
  EXPECT_EQ(output.before_break(), "");
  output.note_break();
  output.add("second\n");
  EXPECT_EQ(output.before_break(), "first\n");
  EXPECT_EQ(output.last_lines(), "first\nsecond\n");
  output.note_break();
  EXPECT_EQ(output.before_break(), "first\nsecond\n");
}

TEST(PolicyOutput, AFileThatCannotBeWrittenIsSaidAndNothingElse) {
  PolicyOutput output;
  output.write_to("/proc/nowhere/printed.txt");
  EXPECT_EQ(output.problem(), "") << "nothing was printed";
  output.add("one\n");
  EXPECT_EQ(output.problem(), "/proc/nowhere/printed.txt: cannot be written");
  EXPECT_EQ(output.last_lines(), "one\n");
}

}  // namespace
}  // namespace karst::test
