// The karst that only flies (KARST_FLIGHT_ONLY): it names every command of the whole one, and those that it
// lacks say how to get them.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "sdk/tools/karst_command.h"
#include "tests/closed_loop/command.h"

namespace karst::tools {
namespace {

using Names = std::set<std::string>;

/// What the help of the whole karst lists below "Subcommands:".
Names listed_by_the_whole_karst(const std::string& group) {
  const Output help = run_command(std::string(KARST_BINARY_DIR) + "/bin/karst " + group + " --help");
  EXPECT_EQ(help.code, 0) << help.text;
  std::istringstream lines(help.text.substr(help.text.find("Subcommands:\n") + 13));
  Names names;
  for (std::string line; std::getline(lines, line);)
    if (line.size() > 2 && line.starts_with("  ") && line[2] != ' ') {
      std::istringstream words(line);
      std::string name;
      words >> name;
      names.insert(name);
    }
  return names;
}

Names names_below(const CLI::App& app) {
  Names names;
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!below->get_group().empty()) names.insert(below->get_name());
  return names;
}

/// Why it is refused; "" if it is not. The words as they are typed.
std::string refusal(std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());
  try {
    karst_command()->parse(words);
  } catch (const CLI::Error& e) {
    return "a usage error: " + std::string(e.what());
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST(FlightCommand, NamesEveryCommandOfTheWholeKarst) {
  const auto app = karst_command();
  const Names all = listed_by_the_whole_karst("");
  EXPECT_GE(all.size(), 15u);
  EXPECT_EQ(names_below(*app), all);
  for (const char* group : {"policy", "cave"})
    EXPECT_EQ(names_below(*app->get_subcommand(group)), listed_by_the_whole_karst(group)) << group;
}

TEST(FlightCommand, TellsHowToGetWhatItLacks) {
  EXPECT_EQ(refusal({"compare", "a.info", "--jobs", "2"}),
            "`karst compare` is not in this build, which only flies; `make build` adds it");
  EXPECT_EQ(refusal({"policy", "check", "mine.so"}),
            "`karst policy check` is not in this build, which only flies; `make build` adds it");
  EXPECT_EQ(refusal({"cave", "describe", "a.info", "--json"}),
            "`karst cave describe` is not in this build, which only flies; `make build` adds it");
}

TEST(FlightCommand, RefusesToSelectAPolicy) {
  EXPECT_NE(refusal({"fly", "--cave", "none.info", "--policy", "auto"}).find("`make build` adds it"),
            std::string::npos);
}

TEST(FlightCommand, RefusesToReportACampaign) {
  const std::filesystem::path folder = fresh_folder("no_run");
  const std::string why = refusal({"report", folder.string()});
  EXPECT_NE(why.find("holds no mission.info"), std::string::npos) << why;
  EXPECT_NE(why.find("`make build` adds it"), std::string::npos) << why;
}

}  // namespace
}  // namespace karst::tools
