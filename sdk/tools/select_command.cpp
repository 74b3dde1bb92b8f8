#include "sdk/tools/select_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "core_stack/common/unit_text.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/selection/describe.h"
#include "sdk/selection/figure_words.h"
#include "sdk/selection/goal.h"
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
  std::string cave, start, out, preset, battery;
  std::vector<std::string> goals;  // or metrics
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

std::optional<selection::BestOnAverage> best_on_average(const Experience& e, const SelectArguments& args) {
  const selection::SelectOptions& o = args.options;
  return selection::best_on_average(e, selection::metric_of(e, o.metric, args.cave), o.conditions);
}

void print(const Experience& e, const selection::CaveFigures& cave, const Selected& s,
           const SelectArguments& args) {
  const std::string goal = selection::goal_of(args.options.metric);
  print_out("Asked: %s%s\n", goal.empty() ? "" : ("for " + goal + ", ").c_str(),
            in_words(args.options.conditions).c_str());
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
    if (const auto best = best_on_average(e, args))
      print_sentences(selection::best_on_average_in_words(e, *best, args.options.metric) + ".");
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
  if (const std::string second = selection::runner_up_in_words(e, s, metric); !second.empty())
    print_sentences(second + ".");
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
  const selection::AskedConditions& asked = args.options.conditions;
  j["goal"] = selection::goal_of(args.options.metric);
  j["conditions"] = ordered_json::object();
  if (!asked.vehicle.empty()) j["conditions"]["vehicle"] = asked.vehicle;
  if (!asked.sensors.empty()) j["conditions"]["sensors"] = asked.sensors;
  if (std::isfinite(asked.endurance_s)) j["conditions"]["endurance_s"] = asked.endurance_s;
  if (asked.robots > 0) j["conditions"]["robots"] = asked.robots;
  j["evidence"] = {{"flights", s.evidence.flights},
                   {"caves", s.evidence.caves},
                   {"flights_as_asked", s.evidence.flights_as_asked},
                   {"caves_as_asked", s.evidence.caves_as_asked}};
  j["limit"] = s.limit;
  j["bandwidth"] = known(s.fit.kernel.bandwidth);
  j["figures"] = ordered_json::array();
  for (std::size_t f = 0; f < s.fit.kernel.weights.size(); ++f)
    if (s.fit.kernel.weights[f] > 0) j["figures"].push_back(selection::figure_definitions()[f].name);
  j["near"] = ordered_json::array();
  for (const selection::NearCave& n : s.near)
    j["near"].push_back(
        {{"cave", e.caves[n.cave].name},
         {"distance", n.distance.value},
         {"weight", n.weight},
         {"most_unlike_in",
          selection::figure_definitions()[static_cast<std::size_t>(n.distance.farthest)].name}});
  if (s.refused) {
    if (const auto best = best_on_average(e, args)) {
      const selection::Preset& otherwise = e.contestants[best->contestant];
      j["best_on_average"] = {{"contestant", otherwise.name},
                              {"policy", otherwise.policy},
                              {"parameters", parameters_json(otherwise)},
                              {"caves", best->caves},
                              {"vehicle", best->vehicle}};
    }
    return j;
  }
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
  if (s.refused) {
    if (!args.preset.empty()) print_error("No preset is written to %s.\n", args.preset.c_str());
    return kNothingSimilar;
  }
  if (!args.preset.empty()) {
    const selection::Preset& first = e.contestants[s.ranking.front().contestant];
    evaluation::write_whole_file(args.preset,
                                 selection::to_info({first.policy, first.parameters},
                                                    "karst select --cave " + args.cave + "\n" + s.reason));
  }
  return 0;
}

constexpr std::array<const char*, selection::kRules> kRuleWords{
    "selected",         "by conditions, not the cave", "always the overall best",
    "best by the goal", "best by the vehicle",         "drawn at random"};

std::string percent(double share) { return core::format_text("%.1f", 100 * share); }

std::string share_words(const selection::Share& s) {
  return percent(s.mean) + (std::isnan(s.low) ? "" : " (" + percent(s.low) + " to " + percent(s.high) + ")");
}

void print_rules(const std::array<selection::RuleValue, selection::kRules>& rules) {
  print_out("  %-28s %20s %20s %20s\n", "%", "is the best", "within 5 %", "lost");
  for (std::size_t r = 0; r < selection::kRules; ++r)
    print_out("  %-28s %20s %20s %20s\n", kRuleWords[r], share_words(rules[r].best).c_str(),
              share_words(rules[r].within).c_str(), share_words(rules[r].lost).c_str());
}

ordered_json to_json(const selection::Share& s) {
  return {{"mean", known(s.mean)}, {"low", known(s.low)}, {"high", known(s.high)}};
}

ordered_json to_json(const std::array<selection::RuleValue, selection::kRules>& rules) {
  ordered_json j;
  for (std::size_t r = 0; r < selection::kRules; ++r)
    j[core::name_of(static_cast<selection::Rule>(r))] = {{"best", to_json(rules[r].best)},
                                                         {"within_5_percent", to_json(rules[r].within)},
                                                         {"lost", to_json(rules[r].lost)}};
  return j;
}

ordered_json to_json(const Experience& e, const selection::LeaveOneOut& l) {
  ordered_json j{{"goals", l.metrics}, {"caves", l.caves}, {"refused", l.refused}};
  j["rules"] = to_json(l.all);
  j["rules_answered"] = to_json(l.answered);
  for (std::size_t r = 0; r < selection::kRules; ++r)
    j["lost_by_selected_over"][core::name_of(static_cast<selection::Rule>(r))] = to_json(l.lost_ratio[r]);
  j["choices"] = ordered_json::array();
  for (const selection::LeftOut& c : l.choices) {
    const selection::Site& site = e.sites[c.site];
    ordered_json one{{"cave", e.caves[site.cave].name},
                     {"condition", e.conditions[site.condition].name},
                     {"metric", e.metrics[c.metric]},
                     {"nearest", known(c.nearest)},
                     {"refused", c.refused},
                     {"best", e.contestants[c.best].name},
                     {"best_value", c.best_value}};
    for (std::size_t r = 0; r < selection::kRules; ++r) {
      const auto rule = static_cast<selection::Rule>(r);
      one[core::name_of(rule)] = {{"value", c.by[r].value}, {"lost", c.by[r].lost}};
      if (rule != selection::Rule::chance)
        one[core::name_of(rule)]["contestant"] = e.contestants[c.by[r].contestant].name;
    }
    j["choices"].push_back(one);
  }
  return j;
}

/// One line for each cave: what the choices for it lost on average.
void print_caves(const Experience& e, const selection::LeaveOneOut& l) {
  print_out("  %-24s %8s %8s %8s %8s   what is best there, by goal\n", "lost, %", "nearest", "selected",
            "overall", "random");
  for (std::size_t c = 0; c < e.caves.size(); ++c) {
    double selected = 0, overall = 0, chance = 0, nearest = 0;
    int n = 0;
    bool refused = false;
    std::string best;
    std::set<std::string> named;
    for (const selection::LeftOut& x : l.choices) {
      if (e.sites[x.site].cave != c) continue;
      const auto lost = [&](selection::Rule r) { return 100 * x.by[static_cast<std::size_t>(r)].lost; };
      selected += lost(selection::Rule::selected);
      overall += lost(selection::Rule::overall);
      chance += lost(selection::Rule::chance);
      nearest = x.nearest;
      refused |= x.refused;
      ++n;
      const std::string& name = e.contestants[x.best].name;
      if (named.insert(name).second) best += (best.empty() ? "" : ", ") + name;
    }
    if (n == 0) continue;
    print_out("  %-24s %8.2f %8.1f %8.1f %8.1f   %s%s\n", e.caves[c].name.c_str(), nearest, selected / n,
              overall / n, chance / n, best.c_str(), refused ? " (would be refused)" : "");
  }
}

/// What telling helps: the rows of one goal or of one condition alone.
void print_parts(const Experience& e, const selection::LeaveOneOut& l) {
  const auto part = [&](const std::string& name, const auto& counts) {
    std::vector<selection::LeftOut> some;
    std::copy_if(l.choices.begin(), l.choices.end(), std::back_inserter(some), counts);
    if (some.empty()) return;
    const auto value = value_of(e, some);
    const auto lost = [&](selection::Rule r) {
      return percent(value[static_cast<std::size_t>(r)].lost.mean);
    };
    print_out("  %-28s %9s %12s %9s %9s\n", name.c_str(), lost(selection::Rule::selected).c_str(),
              lost(selection::Rule::conditions).c_str(), lost(selection::Rule::overall).c_str(),
              lost(selection::Rule::chance).c_str());
  };
  print_out("  %-28s %9s %12s %9s %9s\n", "lost, %", "selected", "conditions", "overall", "random");
  for (std::size_t m = 0; m < e.metrics.size(); ++m)
    part(e.metrics[m], [m](const selection::LeftOut& x) { return x.metric == m; });
  if (e.conditions.size() < 2) return;
  for (std::size_t q = 0; q < e.conditions.size(); ++q)
    part(e.conditions[q].name, [&](const selection::LeftOut& x) { return e.sites[x.site].condition == q; });
}

void leave_one_out(const SelectArguments& args) {
  const Experience e = experience_of(args);
  std::vector<std::string> metrics;
  for (const std::string& goal : args.goals) metrics.push_back(selection::metric_for(goal, "karst select"));
  if (metrics.empty()) metrics = selection::goals_flown(e);
  const selection::LeaveOneOut l = selection::leave_one_out(e, metrics, "karst select");
  if (args.json) {
    print_json(to_json(e, l));
    return;
  }
  print_out("Each cave left out in turn, selected for from the others: %s, %s, %s, %s\n",
            core::counted(l.caves, "cave").c_str(), core::counted(e.conditions.size(), "condition").c_str(),
            core::counted(metrics.size(), "goal").c_str(), core::counted(l.choices.size(), "choice").c_str());
  print_caves(e, l);
  print_parts(e, l);
  print_out("Means over the caves (95 %% interval over the caves):\n");
  print_rules(l.all);
  if (l.refused > 0 && l.refused < l.choices.size()) {
    print_out("of the %zu choices that would not be refused\n", l.choices.size() - l.refused);
    print_rules(l.answered);
  }
  const selection::Share& ratio = l.lost_ratio[static_cast<std::size_t>(selection::Rule::overall)];
  print_sentences(core::format_text(
      "Selecting loses %.2f times what the overall best loses (95 %% interval %.2f to %.2f, from caves drawn "
      "with replacement).",
      ratio.mean, ratio.low, ratio.high));
  print_sentences(
      "Within 5 %: what it found is at least as good as the best there but for 5 % of that. Lost: the share "
      "of the best that was lost. Drawn at random: the mean over all that flew there.");
  if (l.caves < kManyCaves)
    print_out(
        "%zu caves are few: by chance alone a share of 50 %% is off by up to %.0f points, 95 times in 100.\n",
        l.caves, 100 * 1.96 * 0.5 / std::sqrt(static_cast<double>(l.caves)));
}

void learn(const SelectArguments& args) {
  if (args.out.empty()) throw InputError("karst select", "--learn", "needs --out FILE.info");
  if (std::filesystem::path(args.out).extension() != ".info")
    throw InputError("--out", args.out, "expected a name that ends in .info");
  const Experience e = selection::load_experience(args.learn, tell);
  evaluation::write_whole_file(args.out, selection::to_info(e));
  print_out("%s: %zu contestants in %zu caves, %s\n", args.out.c_str(), e.contestants.size(), e.caves.size(),
            core::counted(e.conditions.size(), "condition").c_str());
}

/// Goal and conditions as asked. Throws InputError.
void complete(SelectArguments& args) {
  if (!args.cave.empty() && args.goals.size() > 1)
    throw InputError("karst select", "--for", "a policy is selected for one goal");
  if (!args.goals.empty())
    args.options.metric = selection::metric_for(args.goals.front(), "karst select --for");
  selection::AskedConditions& asked = args.options.conditions;
  if (args.cave.empty() &&
      (!asked.vehicle.empty() || !asked.sensors.empty() || asked.robots > 0 || !args.battery.empty()))
    throw InputError("karst select", "--vehicle, --sensors, --battery, --team", "go with --cave");
  if (args.battery.empty()) return;
  core::OptionTable table;
  table.add("battery", asked.endurance_s, "s", 6, 1e5, "");
  table.set("karst select --battery", "battery", args.battery);
}

int run(SelectArguments args) {
  complete(args);
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
      "  karst select --for deepest --vehicle camera_uav --battery \"8 min\" --cave new.info --results "
      "mine.info\n"
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
  std::string names;
  for (const selection::Goal& g : selection::goals())
    names += (names.empty() ? "" : ", ") + std::string(g.name) + " (" + std::string(g.meaning) + ")";
  select
      ->add_option("--for,--metric", args->goals,
                   "the goal: " + names +
                       "; or the figure to do best in; default coverage_auc; several with "
                       "--leave-one-out, default: all that were flown")
      ->type_name(kMetric)
      ->check(not_empty());
  select->add_option("--vehicle", args->options.conditions.vehicle, "such as camera_uav")->check(not_empty());
  select->add_option("--sensors", args->options.conditions.sensors, "of the vehicle, such as os0_32")
      ->check(not_empty());
  select->add_option("--battery", args->battery, "how long a vehicle can fly, such as \"8 min\"")
      ->check(not_empty());
  select->add_option("--team", args->options.conditions.robots, "number of vehicles")
      ->check(CLI::Range(1, 31));
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
