// Completion and manual pages know every command and option; bash, zsh and groff read them.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core_stack/common/character_count.h"
#include "sdk/tools/help/command_tree.h"
#include "sdk/tools/help/completion.h"
#include "sdk/tools/help/help_formatter.h"
#include "sdk/tools/help/man_pages.h"
#include "sdk/tools/help/value_words.h"
#include "sdk/tools/karst_command.h"
#include "tests/closed_loop/command.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Calls `visit` with every command that help shows, and the words that lead to it.
void for_each_command(const CLI::App& app, const std::string& words,
                      const std::function<void(const CLI::App&, const std::string&)>& visit) {
  visit(app, words);
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!below->get_group().empty()) for_each_command(*below, words + " " + below->get_name(), visit);
}

Names commands_below(const CLI::App& app) {
  Names out;
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!below->get_group().empty()) out.insert(below->get_name());
  return out;
}

Names options_of(const CLI::App& app) {
  Names out;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) out.insert("--" + name);
    for (const std::string& name : option->get_snames()) out.insert("-" + name);
  }
  return out;
}

const Command& command_named(const std::vector<Command>& commands, const std::string& words) {
  for (const Command& command : commands)
    if (joined(command.words) == words) return command;
  throw std::runtime_error("no command " + words);
}

std::string written(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

TEST(CommandTree, HasTheCommandsThatHelpShowsAndNoOther) {
  const auto app = karst_command();
  const std::vector<Command> commands = commands_of(*app);
  std::size_t shown = 0;
  for_each_command(*app, "karst", [&](const CLI::App& c, const std::string& words) {
    ++shown;
    const Command& found = command_named(commands, words);
    EXPECT_EQ(Names(found.below.begin(), found.below.end()), commands_below(c)) << words;
    EXPECT_FALSE(found.summary.empty()) << words;
  });
  EXPECT_EQ(commands.size(), shown);
  EXPECT_GE(shown, 20u);
  for (const char* hidden : {"karst trials", "karst man", "karst policy check-one"})
    EXPECT_THROW(command_named(commands, hidden), std::runtime_error) << hidden;
}

TEST(CommandTree, KnowsWhatAValueIs) {
  CLI::App app("Tests.\n\n  karst --out x", "karst");
  std::string text;
  std::vector<std::string> list;
  bool flag = false;
  double number = 0.5;
  app.add_option("maps", list, "maps")->type_name("FILE")->required();
  app.add_option("--out,-o", text, "folder")->type_name("FOLDER");
  app.add_option("--form", text, "of the mesh")->check(CLI::IsMember({"ply", "stl"}));
  app.add_option("--set", list, "key=value")->allow_extra_args(false);
  app.add_option("--size", number, "metres")->capture_default_str();
  app.add_option("--hidden", number, "")->group("");
  app.add_flag("--json", flag, "JSON");
  const std::vector<Command> commands = commands_of(app);
  ASSERT_EQ(commands.size(), 1u);
  const Command& c = commands.front();
  EXPECT_EQ(c.summary, "Tests");
  EXPECT_EQ(c.details, "  karst --out x");
  ASSERT_EQ(c.arguments.size(), 1u);
  EXPECT_EQ(c.arguments[0].argument, "maps");
  EXPECT_EQ(c.arguments[0].kind, ValueKind::file);
  EXPECT_TRUE(c.arguments[0].required && c.arguments[0].repeats && c.arguments[0].several);
  ASSERT_EQ(c.options.size(), 6u) << "with --help, without --hidden";
  const auto option = [&](std::size_t i) { return c.options[i]; };
  EXPECT_EQ(option(0).names, (std::vector<std::string>{"-h", "--help"}));
  EXPECT_EQ(option(1).names, (std::vector<std::string>{"-o", "--out"}));
  EXPECT_EQ(option(1).kind, ValueKind::folder);
  EXPECT_EQ(option(2).kind, ValueKind::choice);
  EXPECT_EQ(option(2).choices, (std::vector<std::string>{"ply", "stl"}));
  EXPECT_EQ(option(3).kind, ValueKind::other);
  EXPECT_TRUE(option(3).repeats && !option(3).several);
  EXPECT_EQ(option(4).default_text, "0.5");
  EXPECT_EQ(option(5).kind, ValueKind::none);
}

TEST(ValueWords, AreThoseOfPeople) {
  for (const auto& [type, words] :
       {std::pair{"FLOAT:in 0.05 to 1", "NUMBER 0.05 to 1"},
        std::pair{"INT:INT in [1 - 256]", "INTEGER 1 to 256"}, std::pair{"FLOAT:POSITIVE", "NUMBER above 0"},
        std::pair{"TEXT:{ply,stl}", "ply|stl"}, std::pair{"SECONDS:in 0.1 to 600", "SECONDS 0.1 to 600"},
        std::pair{"POLICY|FILE", "POLICY|FILE"}, std::pair{"UINT", "INTEGER"}, std::pair{"", ""}})
    EXPECT_EQ(type_words(type), words);
}

/// Of a command with everything, at this width.
std::string help_at(std::size_t columns) {
  CLI::App app(
      "Flies.\n\n  karst fly an-example-that-is-longer-than-the-lines-of-this-terminal.info\n\n"
      "Exit code: 0 the mission went as planned, 2 it did not, 1 nothing flew.",
      "karst fly");
  app.formatter(std::make_shared<HelpFormatter>(columns));
  std::vector<std::string> maps;
  double size = 0.2;
  app.add_option("maps", maps, "run directories")->type_name("FILE")->required()->expected(2, 1 << 29);
  app.add_option("--size", size, "edge of the map's cells: what is thinner than this is not seen")
      ->check(CLI::Range(0.05, 1.0, "in 0.05 to 1"))
      ->capture_default_str();
  return app.help();
}

TEST(Help, IsWrappedAndAligned) {
  const std::string help = help_at(60);
  for (const char* part :
       {"\n  karst fly an-example-that-is-longer-than-the-lines-of-this-terminal.info\n",
        "\nExit code: 0 the mission went as planned, 2 it did not, 1\nnothing flew.\n\nUsage:",
        "edge of the map's cells: what\n                              is thinner",
        "  --size NUMBER 0.05 to 1, default 0.2"})
    EXPECT_NE(help.find(part), std::string::npos) << part << " in:\n" << help;
  EXPECT_NE(help_at(200).find("cells: what is thinner than this is not seen\n"), std::string::npos);
}

// Lines had up to 288 columns.
TEST(Help, OfEveryCommandFitsItsWidth) {
  const auto app = karst_command();
  app->formatter(std::make_shared<HelpFormatter>(80));
  for_each_command(*app, "karst", [&](const CLI::App& c, const std::string& words) {
    std::istringstream lines(HelpFormatter(80).make_help(&c, words, CLI::AppFormatMode::Normal));
    for (std::string line; std::getline(lines, line);) {
      const bool example =
          line.starts_with("  ") && !line.starts_with("  -") && !line.starts_with(std::string(30, ' '));
      const bool one_word = line.find_last_of(' ') < 30;  // such as a path
      EXPECT_TRUE(example || one_word || core::character_count(line) <= 80) << words << ": " << line;
    }
  });
}

// Some began with a capital, some did not.
TEST(Help, OptionsAreNoSentences) {
  const auto app = karst_command();
  for (const char* name : {"fly", "explain", "table", "replay", "completion"})
    for (const CLI::Option* option : app->get_subcommand(name)->get_options()) {
      const std::string text = option->get_description();
      EXPECT_FALSE(text.ends_with('.')) << name << ": " << text;
      EXPECT_FALSE(text.size() > 1 && text[0] >= 'A' && text[0] <= 'Z' && text[1] >= 'a' && text[1] <= 'z')
          << name << ": " << text;
    }
}

/// bash with the completion read, in a folder of its own.
class Bash {
 public:
  explicit Bash(const std::string& name) : folder_(fresh_folder("completion_" + name)) {
    written(folder_ / "karst.bash", bash_completion(commands_of(*karst_command())));
  }
  const fs::path& folder() const { return folder_; }

  /// What is proposed for the last of the words, each between blanks; "''" stands for an empty one.
  Names proposed(const std::string& words) const {
    const std::string script = written(folder_ / "ask.bash",
                                       "source ./karst.bash || exit 1\n"
                                       "COMP_WORDS=(" +
                                           words +
                                           ")\n"
                                           "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                                           "_karst\n"
                                           "for reply in \"${COMPREPLY[@]}\"; do echo \"$reply\"; done\n");
    const Output out = run_command("cd " + folder_.string() + " && bash --norc " + script);
    EXPECT_EQ(out.code, 0) << out.text;
    Names names;
    std::istringstream lines(out.text);
    for (std::string line; std::getline(lines, line);) names.insert(line);
    return names;
  }

 private:
  fs::path folder_;
};

TEST(BashCompletion, OffersEveryCommandAndEveryOption) {
  const auto app = karst_command();
  const Bash bash("all");
  for_each_command(*app, "karst", [&](const CLI::App& c, const std::string& words) {
    if (!commands_below(c).empty()) {
      EXPECT_EQ(bash.proposed(words + " ''"), commands_below(c)) << words;
    }
    EXPECT_EQ(bash.proposed(words + " -"), options_of(c)) << words;
  });
}

TEST(BashCompletion, OffersWhatBeginsSo) {
  const Bash bash("begun");
  EXPECT_EQ(bash.proposed("karst rep"), (Names{"replay", "report"}));
  EXPECT_EQ(bash.proposed("karst policy new --t"), (Names{"--template"}));
  EXPECT_EQ(bash.proposed("karst fly --rec"), (Names{"--record-requests"}));
  EXPECT_EQ(bash.proposed("karst nonsense ''"), bash.proposed("karst ''"));
}

TEST(BashCompletion, OffersValues) {
  const Bash bash("values");
  written(bash.folder() / "small cave.info", "");
  fs::create_directories(bash.folder() / "small_runs");
  EXPECT_EQ(bash.proposed("karst completion ''"), (Names{"bash", "zsh"}));
  const Names templates = bash.proposed("karst policy new mine --template ''");
  for (const char* name : {"memory", "nearest", "tour"}) EXPECT_TRUE(templates.contains(name)) << name;
  EXPECT_EQ(bash.proposed("karst policy new mine --template = t"), (Names{"tour"})) << "as bash splits words";
  EXPECT_EQ(bash.proposed("karst policy new mine --template ="), templates);
  EXPECT_EQ(bash.proposed("karst fly --cave small"), (Names{"small cave.info", "small_runs"}));
  EXPECT_EQ(bash.proposed("karst fly small"), (Names{"small cave.info", "small_runs"})) << "the mission file";
  EXPECT_EQ(bash.proposed("karst fly --out small"), (Names{"small_runs"})) << "a folder";
  EXPECT_EQ(bash.proposed("karst fly --seed ''"), Names{}) << "a number";
  EXPECT_EQ(bash.proposed("karst fly --quiet sm"), (Names{"small cave.info", "small_runs"}))
      << "behind a flag";
  EXPECT_EQ(bash.proposed("karst tune p --caves a.info small"), (Names{"small cave.info", "small_runs"}))
      << "a further one of several";
}

TEST(BashCompletion, OffersThePoliciesOfTheKarstThatIsTyped) {
  const Bash bash("policies");
  const std::string karst = std::string(KARST_BINARY_DIR) + "/bin/karst";
  const Names near = bash.proposed(karst + " fly --policy near");
  EXPECT_TRUE(near.contains("nearest_frontier"));
  for (const std::string& name : near) EXPECT_TRUE(name.starts_with("near")) << name;
  written(bash.folder() / "nearest.info", "");
  const Names both = bash.proposed(karst + " compare near");
  EXPECT_TRUE(both.contains("nearest_frontier") && both.contains("nearest.info"));
  for (const std::string& name : bash.proposed(karst + " tune ''"))
    EXPECT_EQ(name.find_first_of(" :"), std::string::npos) << name << " is no policy";
}

// Behind --set nothing was offered.
TEST(BashCompletion, OffersTheKeysOfSettingsAndTheirChoices) {
  const Bash bash("settings");
  const std::string karst = std::string(KARST_BINARY_DIR) + "/bin/karst";
  EXPECT_EQ(bash.proposed(karst + " fly --set mission.max"), Names{"mission.max_flight_time="});
  for (const char* command : {"preflight", "compare", "tune"})
    EXPECT_EQ(bash.proposed(karst + " " + command + " --set mission.max"), Names{"mission.max_flight_time="})
        << command;
  const Names policy = bash.proposed(karst + " fly --set policy.");
  for (const char* key : {"policy.isolation=", "policy.auto.survey="})
    EXPECT_TRUE(policy.contains(key)) << key;
  EXPECT_EQ(bash.proposed(karst + " fly --set = mission.max"), Names{"mission.max_flight_time="})
      << "as bash splits words";
  EXPECT_EQ(bash.proposed(karst + " cave generate --set vol"), Names{"volume="});
  EXPECT_TRUE(bash.proposed(karst + " replay --set map.res").contains("map.resolution="));
  EXPECT_EQ(bash.proposed(karst + " fly --set policy.isolation ="),
            (Names{"in_process", "process", "where_possible"}));
  EXPECT_EQ(bash.proposed(karst + " fly --set policy.isolation = wh"), Names{"where_possible"});
  EXPECT_EQ(bash.proposed(karst + " fly --set = policy.isolation = wh"), Names{"where_possible"});
  EXPECT_EQ(bash.proposed(karst + " fly --set seed ="), Names{}) << "a number";
  EXPECT_EQ(bash.proposed(karst + " fly --set nonsense = x"), Names{});
}

TEST(BashCompletion, OffersPresetsAndMetrics) {
  const Bash bash("presets");
  EXPECT_EQ(bash.proposed("karst cave generate --preset ma"), Names{"maze"});
  for (const char* command : {"results", "report", "compare", "select", "tune"}) {
    const Names metrics = bash.proposed(std::string("karst ") + command + " --metric coverage");
    EXPECT_TRUE(metrics.contains("coverage") && metrics.contains("coverage_auc")) << command;
  }
}

/// The text of a function of the script.
std::string function_in(const std::string& script, const std::string& name) {
  const std::size_t begin = script.find("\n" + name + "() {\n");
  EXPECT_NE(begin, std::string::npos) << name;
  return begin == std::string::npos ? "" : script.substr(begin, script.find("\n}\n", begin) - begin);
}

TEST(ZshCompletion, HasEveryCommandAndEveryOption) {
  const auto app = karst_command();
  const std::string script = zsh_completion(commands_of(*app));
  EXPECT_TRUE(script.starts_with("#compdef karst\n"));
  for_each_command(*app, "karst", [&](const CLI::App& c, const std::string& words) {
    std::string name = "_" + words;
    for (std::size_t at = name.find(' '); at != std::string::npos; at = name.find(' '))
      name.replace(at, 1, "__");
    const std::string function = function_in(script, name);
    for (const std::string& below : commands_below(c)) {
      EXPECT_NE(function.find("'" + below + ":"), std::string::npos) << words << " " << below;
      EXPECT_NE(function.find(below + ") " + name + "__" + below + " ;;"), std::string::npos) << words;
    }
    for (const std::string& option : options_of(c)) {
      const bool there = function.find(")" + option + "[") != std::string::npos ||
                         function.find(")" + option + "=[") != std::string::npos ||
                         function.find(")" + option + "+[") != std::string::npos ||
                         function.find("'*" + option + "=[") != std::string::npos ||
                         function.find("'*" + option + "+[") != std::string::npos;
      EXPECT_TRUE(there) << words << " " << option;
    }
  });
}

TEST(ZshCompletion, OffersTheKeysOfSettingsPresetsAndMetrics) {
  const std::string script = zsh_completion(commands_of(*karst_command()));
  const auto offers = [&script](const char* function, const std::string& action) {
    const std::string text = function_in(script, function);
    EXPECT_NE(text.find(action), std::string::npos) << function << ": " << text;
  };
  offers("_karst__fly", ":KEY=VALUE: _karst_settings fly --keys'");
  offers("_karst__compare", ":KEY=VALUE: _karst_settings fly --keys'");
  offers("_karst__replay", ":KEY=VALUE: _karst_settings replay --keys'");
  offers("_karst__cave__generate", ":KEY=VALUE: _karst_settings cave generate --help'");
  offers("_karst__cave__generate", ":TEXT:(small ");
  offers("_karst__results", ":METRIC:(");
}

TEST(ZshCompletion, ZshReadsIt) {
  if (run_command("command -v zsh").code != 0) GTEST_SKIP() << "zsh is not installed";
  const fs::path file = fresh_folder("completion_zsh") / "_karst";
  const Output read =
      run_command("zsh -f -n " + written(file, zsh_completion(commands_of(*karst_command()))));
  EXPECT_EQ(read.code, 0) << read.text;
  EXPECT_EQ(read.text, "");
}

const DocFolders kNoFolders{"/nowhere", "/nowhere"};

std::string in_roff(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '-' ? std::string("\\-") : std::string(1, c);
  return out;
}

TEST(ManPages, ThereIsOneOfEachCommandWithItsOptions) {
  const auto app = karst_command();
  const auto pages = man_pages(commands_of(*app), "1.2.3", kNoFolders);
  std::size_t shown = 0;
  for_each_command(*app, "karst", [&](const CLI::App& c, const std::string& words) {
    ++shown;
    std::string name = words;
    std::replace(name.begin(), name.end(), ' ', '-');
    ASSERT_TRUE(pages.contains(name + ".1")) << name;
    const std::string& page = pages.at(name + ".1");
    for (const char* section : {"NAME", "SYNOPSIS", "OPTIONS", "FILES", "SEE ALSO"})
      EXPECT_NE(page.find(std::string("\n.SH ") + section + "\n"), std::string::npos) << name << section;
    for (const std::string& option : options_of(c))
      EXPECT_NE(page.find("\\fB" + in_roff(option) + "\\fR"), std::string::npos) << name << " " << option;
    for (const std::string& below : commands_below(c))
      EXPECT_NE(page.find("\\fB" + in_roff(name + "-" + below) + "\\fR(1)"), std::string::npos) << name;
    if (words != "karst") {
      EXPECT_NE(
          page.find("\\fB" + in_roff(name.substr(0, name.size() - c.get_name().size() - 1)) + "\\fR(1)"),
          std::string::npos)
          << name << " does not refer to its group";
    }
  });
  EXPECT_EQ(pages.size(), shown);
}

TEST(ManPages, NameTheDocumentationThatTheirReaderHas) {
  const Command command{.words = {"karst"},
                        .summary = "flies",
                        .details = "See /a-build/share/doc/karst/docs/tune.md.",
                        .options = {},
                        .arguments = {},
                        .below = {}};
  const std::string page =
      man_pages({command}, "1", {"/a-build/share/doc/karst", "/usr/share/doc/karst"}).at("karst.1");
  EXPECT_NE(page.find("\nSee /usr/share/doc/karst/docs/tune.md.\n"), std::string::npos) << page;
  EXPECT_NE(page.find(".SH FILES\n.TP\n\\fI/usr/share/doc/karst\\fR\n"), std::string::npos) << page;
}

TEST(ManPages, TextIsSafeFromRoff) {
  const Command command{.words = {"karst"},
                        .summary = "flies",
                        .details = "A back\\slash.\n.SH no section\n'no request\n\n  an example\n\nthe end",
                        .options = {},
                        .arguments = {},
                        .below = {}};
  const std::string page = man_pages({command}, "1", kNoFolders).at("karst.1");
  EXPECT_NE(page.find("A back\\eslash.\n.br\n\\&.SH no section\n.br\n\\&'no request\n"), std::string::npos)
      << page;
  EXPECT_NE(page.find(".nf\n  an example\n"), std::string::npos) << page;
  EXPECT_NE(page.find("\nthe end\n"), std::string::npos) << page;
}

TEST(ManPages, GroffReadsThemWithoutAWarning) {
  if (run_command("command -v groff").code != 0) GTEST_SKIP() << "groff is not installed";
  const fs::path folder = fresh_folder("man_pages");
  for (const auto& [name, text] : man_pages(commands_of(*karst_command()), "1.2.3", kNoFolders))
    written(folder / name, text);
  // A long path cannot be broken: no fault of the page.
  const Output read = run_command("for page in " + folder.string() +
                                  "/*.1; do groff -man -K utf8 -T utf8 -ww -W break -z $page; done");
  EXPECT_EQ(read.code, 0);
  EXPECT_EQ(read.text, "");
}

}  // namespace
}  // namespace karst::tools
