#include "sdk/tools/select_command.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/unit_text.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/selection/describe.h"
#include "sdk/selection/figure_words.h"
#include "sdk/selection/leave_one_out.h"
#include "sdk/selection/load_experience.h"
#include "sdk/selection/preset.h"
#include "sdk/selection/select_words.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

using core::InputError;
using nlohmann::ordered_json;
using selection::Experience;
using selection::Selected;

constexpr std::size_t kManyCaves = 30;  // with fewer caves a fraction may be off by 18 points and more
constexpr int kNothingSimilar = 3;      // exit code: nothing similar was flown

struct SelectArguments {
  std::string cave, start, out, preset;
  std::vector<std::string> results, learn;
  selection::SelectOptions options;
  bool json = false, leave_one_out = false;
};

ordered_json known(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(); }

void tell(const std::string& message) { print_wrapped(stderr, 2, "%s\n", message.c_str()); }

Experience experience_of(const SelectArguments& args) {
  std::vector<std::string> files = args.results;
  if (files.empty() && !selection::installed_experience().empty())
    files = {selection::installed_experience()};
  if (files.empty())
    throw InputError("karst select", "--results",
                     "give the store of a campaign, or an experience that --learn wrote: none is installed");
  return selection::load_experience(files, tell);
}

std::string interval_text(const std::string& metric, const selection::Expected& x) {
  if (std::isnan(x.low)) return "not known";
  return selection::metric_value_text(metric, x.low) + " to " + selection::metric_value_text(metric, x.high);
}

/// Wrapped to the terminal; a file or a pipe gets lines of a length that can be read, too.
void print_sentences(const std::string& text) {
  constexpr std::size_t kColumnsOfAFile = 100;
  const std::size_t columns = terminal_columns(stdout);
  print_out("%s\n", wrapped(text, columns > 0 ? columns : kColumnsOfAFile, 2).c_str());
}

void print(const Experience& e, const selection::CaveFigures& cave, const Selected& s,
           const SelectArguments& args) {
  print_out("The cave:\n%s", selection::to_text(cave).c_str());
  print_out("%s:\n", s.flown ? "This very cave was flown; all rests on that. Nearest" : "Caves like it");
  for (std::size_t i = 0; i < s.near.size() && i < 5; ++i) {
    const selection::NearCave& n = s.near[i];
    const auto& far = selection::figure_definitions()[static_cast<std::size_t>(n.distance.farthest)];
    print_out("  %-24s distance %5.2f, weight %3.0f %%, most unlike in %s (%s here, %s there)\n",
              e.caves[n.cave].name.c_str(), n.distance.value, 100 * n.weight, std::string(far.name).c_str(),
              selection::plain_number(cave.*far.value).c_str(),
              selection::plain_number(e.caves[n.cave].figures.*far.value).c_str());
  }
  if (s.refused) {
    print_sentences("No policy is named: " + core::unit_text(s.reason) + ".");
    return;
  }
  const std::string& metric = args.options.metric;
  print_out("Expected %s (%s), %.0f %% interval:\n", selection::metric_words(metric).c_str(), metric.c_str(),
            100 * args.options.level);
  for (const selection::Expected& x : s.ranking)
    print_out("  %-24s %8s   %s\n", e.contestants[x.contestant].name.c_str(),
              selection::metric_value_text(metric, x.value).c_str(), interval_text(metric, x).c_str());
  const selection::Preset& first = e.contestants[s.ranking.front().contestant];
  print_out("Policy: %s\n", first.policy.c_str());
  for (const auto& [key, value] : first.parameters)
    print_out("  %s = %s\n", key.c_str(), core::unit_text(value.data()).c_str());
  print_out("%s:\n",
            s.flown ? "Means over its flights there"
                    : "Means over its flights in these caves, weighted, and not scaled to this cave's size");
  const std::vector<double> figures = expected_figures(e, cave, s, s.ranking.front().contestant);
  for (std::size_t m = 0; m < figures.size(); ++m)
    if (!std::isnan(figures[m]))
      print_out("  %-38s %s\n", selection::metric_words(e.metrics[m]).c_str(),
                selection::metric_value_text(e.metrics[m], figures[m]).c_str());
  print_sentences(s.reason);
  print_sentences("Confidence: " + selection::confidence_in_words(e, s) + ".");
}

ordered_json parameters_json(const selection::Preset& preset) {
  ordered_json j = ordered_json::object();
  for (const auto& [key, value] : preset.parameters) j[key] = value.data();
  return j;
}

ordered_json to_json(const Experience& e, const selection::CaveFigures& cave, const Selected& s,
                     const SelectArguments& args) {
  ordered_json j{{"refused", s.refused},
                 {"flown", s.flown},
                 {"reason", s.reason},
                 {"metric", args.options.metric},
                 {"cave", core::json_of<ordered_json>(selection::to_json(cave))}};
  j["limit"] = s.limit;
  j["bandwidth"] = known(s.bandwidth);
  j["near"] = ordered_json::array();
  for (const selection::NearCave& n : s.near)
    j["near"].push_back(
        {{"cave", e.caves[n.cave].name},
         {"distance", n.distance.value},
         {"weight", n.weight},
         {"most_unlike_in",
          selection::figure_definitions()[static_cast<std::size_t>(n.distance.farthest)].name}});
  if (s.refused) return j;
  const selection::Preset& first = e.contestants[s.ranking.front().contestant];
  j["policy"] = first.policy;
  j["parameters"] = parameters_json(first);
  j["confidence"] = s.confidence;
  j["ranking"] = ordered_json::array();
  for (const selection::Expected& x : s.ranking)
    j["ranking"].push_back({{"contestant", e.contestants[x.contestant].name},
                            {"expected", x.value},
                            {"low", known(x.low)},
                            {"high", known(x.high)}});
  const std::vector<double> figures = expected_figures(e, cave, s, s.ranking.front().contestant);
  for (std::size_t m = 0; m < figures.size(); ++m) j["expected"][e.metrics[m]] = known(figures[m]);
  return j;
}

int select_for(const SelectArguments& args) {
  const selection::Description cave = selection::describe_file(args.cave, args.start);
  const Experience e = experience_of(args);
  const Selected s =
      select(e, cave.figures, args.options, args.cave, selection::mesh_hash_of(args.cave, args.start));
  if (args.json)
    print_json(to_json(e, cave.figures, s, args));
  else
    print(e, cave.figures, s, args);
  if (s.refused) return kNothingSimilar;
  if (!args.preset.empty()) {
    const selection::Preset& first = e.contestants[s.ranking.front().contestant];
    evaluation::write_whole_file(args.preset,
                                 selection::to_info({first.policy, first.parameters},
                                                    "karst select --cave " + args.cave + "\n" + s.reason));
  }
  return 0;
}

void print_shares(const char* name, const selection::LeaveOneOut::Shares& s) {
  print_out("  %-28s %5.0f %% %12.0f %% %12.1f %%\n", name, 100 * s.best, 100 * s.within, 100 * s.regret);
}

void print_answered(const selection::LeaveOneOut& l) {
  print_out("of the %zu caves that would not be refused\n", l.caves.size() - l.refused);
  print_shares("selected", l.selected_answered);
  print_shares("always the overall best", l.overall_answered);
  print_shares("drawn at random", l.chance_answered);
}

void leave_one_out(const SelectArguments& args) {
  const Experience e = experience_of(args);
  const selection::LeaveOneOut l = selection::leave_one_out(e, args.options, "karst select");
  if (args.json) {
    ordered_json j{{"metric", args.options.metric}, {"caves", ordered_json::array()}, {"refused", l.refused}};
    for (const selection::LeftOut& c : l.caves)
      j["caves"].push_back({{"cave", e.caves[c.cave].name},
                            {"nearest", c.nearest},
                            {"refused", c.refused},
                            {"best", e.contestants[c.best].name},
                            {"best_value", c.best_value},
                            {"selected", e.contestants[c.selected].name},
                            {"selected_value", c.selected_value},
                            {"overall", e.contestants[c.overall].name},
                            {"overall_value", c.overall_value},
                            {"chance_value", c.chance_value}});
    const auto fractions = [&j](const char* name, const selection::LeaveOneOut::Shares& s) {
      j[name] = {{"best", known(s.best)}, {"within_5_percent", known(s.within)}, {"lost", known(s.regret)}};
    };
    fractions("selected", l.selected);
    fractions("overall_best", l.overall);
    fractions("chance", l.chance);
    fractions("selected_answered", l.selected_answered);
    fractions("overall_best_answered", l.overall_answered);
    fractions("chance_answered", l.chance_answered);
    print_json(j);
    return;
  }
  print_out("Each cave left out in turn, selected for from the others, by %s:\n",
            args.options.metric.c_str());
  for (const selection::LeftOut& c : l.caves)
    print_out("  %-24s nearest %5.2f  best %s %.3g; selected %s %.3g%s; overall best %s %.3g\n",
              e.caves[c.cave].name.c_str(), c.nearest, e.contestants[c.best].name.c_str(), c.best_value,
              e.contestants[c.selected].name.c_str(), c.selected_value,
              c.refused ? " (would be refused)" : "", e.contestants[c.overall].name.c_str(), c.overall_value);
  print_out("%zu caves               is the best   within 5 %%   lost on average\n", l.caves.size());
  print_shares("selected", l.selected);
  print_shares("always the overall best", l.overall);
  print_shares("drawn at random", l.chance);
  if (l.refused > 0 && l.refused < l.caves.size()) print_answered(l);
  print_out(
      "Within 5 %%: what it found is at least as good as the best there but for 5 %% of that. Lost: the "
      "share of the best\n"
      "that was lost. Drawn at random: the mean over all that flew there.\n");
  if (l.caves.size() < kManyCaves)
    print_out(
        "%zu caves are few: by chance alone a share of 50 %% is off by up to %.0f points, 95 times in 100.\n",
        l.caves.size(), 100 * 1.96 * 0.5 / std::sqrt(static_cast<double>(l.caves.size())));
}

void learn(const SelectArguments& args) {
  if (args.out.empty()) throw InputError("karst select", "--learn", "needs --out FILE.info");
  if (std::filesystem::path(args.out).extension() != ".info")
    throw InputError("--out", args.out, "expected a name that ends in .info");
  const Experience e = selection::load_experience(args.learn, tell);
  evaluation::write_whole_file(args.out, selection::to_info(e));
  print_out("%s: %zu contestants in %zu caves\n", args.out.c_str(), e.contestants.size(), e.caves.size());
}

int run(const SelectArguments& args) {
  const int wanted = !args.cave.empty() + !args.learn.empty() + args.leave_one_out;
  if (wanted != 1)
    throw InputError("karst select", "", "needs one of --cave FILE, --learn STORE, --leave-one-out");
  if (!args.cave.empty()) return select_for(args);
  if (args.leave_one_out)
    leave_one_out(args);
  else
    learn(args);
  return 0;
}

}  // namespace

void add_select_command(CLI::App& app) {
  auto args = std::make_shared<SelectArguments>();
  CLI::App* select = app.add_subcommand(
      "select",
      "Name the policy for a cave, by how policies fared in caves like it\n\n"
      "  karst select --cave caves/new.info --results runs/campaign     a mesh or a cave's .info file\n"
      "  karst select --cave runs/monday/map.bt                         the map of an earlier flight\n"
      "  karst select --cave known.info                                 what a caver knows: width \"4 m\" "
      "...\n"
      "  karst select --learn runs/campaign --out mine.info             distil a campaign\n"
      "  karst select --leave-one-out --results mine.info               what selecting is worth\n\n"
      "Exit code: 0 a policy is named, 3 nothing similar was flown, 1 an error.");
  select->add_option("--cave", args->cave, "mesh, cave .info, map (.bt, .ot), or INFO file of figures")
      ->type_name(kFile)
      ->check(not_empty());
  select->add_option("--start", args->start, "\"x y z\", of a mesh")->check(not_empty());
  select
      ->add_option("--results", args->results, "stores of campaigns, experiences; default: what is installed")
      ->type_name(kFile)
      ->check(not_empty());
  select->add_option("--metric", args->options.metric, "the figure to do best in")
      ->type_name(kMetric)
      ->check(not_empty())
      ->capture_default_str();
  select->add_option("--level", args->options.level, "of the intervals")
      ->check(number_in(0.5, 0.99))
      ->capture_default_str();
  select
      ->add_option("--preset", args->preset,
                   "write the policy with its parameters here, for karst fly --preset")
      ->type_name(kFile)
      ->check(not_empty());
  select->add_option("--learn", args->learn, "stores to distil into --out")
      ->type_name(kFile)
      ->check(not_empty());
  select->add_option("--out", args->out, "of --learn: the experience, an INFO file")
      ->type_name(kFile)
      ->check(not_empty());
  select->add_flag("--leave-one-out", args->leave_one_out, "say what selecting is worth");
  select->add_flag("--json", args->json, "Write JSON");
  select->callback([args] {
    if (const int code = run(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
