// Sentences are broken between words where a terminal's line ends, and nothing is lost.
#include "sdk/terminal/terminal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "core_stack/common/random.h"

namespace karst {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Wrapped, BreaksBetweenWordsAndIndentsWhatGoesOn) {
  EXPECT_EQ(wrapped("the way home is blocked by rock", 12, 2), "the way home\n  is blocked\n  by rock");
  EXPECT_EQ(wrapped("the way home\n", 12, 2), "the way home\n") << "what fits stays";
  EXPECT_EQ(wrapped("a  b\n  c\n\nd", 12, 2), "a  b\n  c\n\nd") << "blanks, lines and paragraphs stay";
  EXPECT_EQ(wrapped("", 12, 2), "");
}

TEST(Wrapped, AWordLongerThanALineStaysWhole) {
  EXPECT_EQ(wrapped("see /a/very/long/path/of/a/run now", 10, 1), "see\n /a/very/long/path/of/a/run\n now");
}

TEST(Wrapped, WithoutAWidthNothingChanges) {
  const std::string text(5000, 'x');
  EXPECT_EQ(wrapped(text + " y", 0, 2), text + " y");
}

TEST(Wrapped, CountsCharactersNotBytes) { EXPECT_EQ(wrapped("grün grün grün", 9, 0), "grün grün\ngrün"); }

TEST(HelpColumns, AreThoseOfTheEnvironmentIfItSaysSome) {
  setenv("COLUMNS", "72", 1);
  EXPECT_EQ(help_columns(), 72u);
  for (const char* wrong : {"", "wide", "-3", "0", "80x"}) {
    setenv("COLUMNS", wrong, 1);
    EXPECT_GE(help_columns(), 20u) << wrong;
    EXPECT_NE(help_columns(), 72u) << wrong;
  }
  unsetenv("COLUMNS");
}

TEST(Wrapped, LosesNoWordAndKeepsTheWidth) {
  core::Random random(7);
  for (int i = 0; i < 300; ++i) {
    const auto columns = static_cast<std::size_t>(random.uniform(10, 60)), indent = columns / 5;
    std::string text;
    for (int w = 0; w < 60; ++w)
      text += (text.empty() ? "" : " ") + std::string(static_cast<std::size_t>(random.uniform(1, 14)), 'a');
    const std::string out = wrapped(text, columns, indent);
    EXPECT_EQ(words_of(out), words_of(text));
    const std::vector<std::string> lines = lines_of(out);
    for (std::size_t n = 0; n < lines.size(); ++n) {
      EXPECT_TRUE(lines[n].size() <= columns || words_of(lines[n]).size() == 1) << lines[n];
      if (n + 1 < lines.size()) {
        EXPECT_GT(lines[n].size() + 1 + words_of(lines[n + 1]).front().size(), columns)
            << "a line ends before it must";
      }
    }
  }
}

const char* const kReason =
    "nothing like this cave was flown: the nearest, maze1, is at distance 3.10, and most unlike is its width";

TEST(PrintWrapped, AFileGetsTheTextAsItIs) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(terminal_columns(file), 0u);
  print_wrapped(file, 2, "refused: %s\n", kReason);
  std::rewind(file);
  std::array<char, 512> text{};
  const std::size_t n = std::fread(text.data(), 1, text.size(), file);
  std::fclose(file);
  EXPECT_EQ(std::string(text.data(), n), std::string("refused: ") + kReason + "\n");
}

TEST(PrintWrapped, ATerminalGetsWholeWordsOnLinesOfItsWidth) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0)
    GTEST_SKIP() << "this machine gives no pseudo-terminals";
  std::FILE* file = std::fopen(ptsname(terminal), "r+");
  ASSERT_NE(file, nullptr);
  winsize size{};
  size.ws_row = 24, size.ws_col = 40;
  ASSERT_EQ(ioctl(fileno(file), TIOCSWINSZ, &size), 0);
  EXPECT_EQ(terminal_columns(file), 40u);
  print_wrapped(file, 2, "refused: %s\n", kReason);
  std::fflush(file);
  std::string seen;
  std::array<char, 512> part{};
  while (seen.find("width") == std::string::npos || seen.back() != '\n') {
    const ssize_t n = read(terminal, part.data(), part.size());
    if (n <= 0) break;
    seen.append(part.data(), static_cast<std::size_t>(n));
  }
  std::fclose(file);
  close(terminal);
  std::erase(seen, '\r');
  EXPECT_EQ(words_of(seen), words_of(std::string("refused: ") + kReason));
  EXPECT_GT(lines_of(seen).size(), 2u) << seen;
  for (const std::string& line : lines_of(seen)) EXPECT_LE(line.size(), 40u) << line;
}

}  // namespace
}  // namespace karst
