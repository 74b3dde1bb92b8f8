#include "sdk/tools/tune_command.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "core_stack/common/counted.h"
#include "core_stack/common/csv_cell.h"
#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/run/run_campaign.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/flight/run_files.h"
#include "sdk/selection/preset.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/interrupt.h"
#include "sdk/tuning/tune.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using campaign::Campaign;
using core::InputError;
using tuning::TuneResult;

struct TuneArguments {
  std::string policy, plugin, out, mission, profile = "campaign", flight_time = "300 s";
  std::string method = core::name_of(tuning::SearchOptions{}.method);
  std::vector<std::string> caves, held_out, parameters, settings;
  std::int64_t seeds = 2;
  std::size_t jobs = std::max(1u, std::thread::hardware_concurrency());
  bool quiet = false, any_binary = false;
  tuning::TuneOptions tune;
};

double flight_time_of(const std::string& text) {
  double s = 0;
  core::OptionTable table;
  table.add("--time", s, "s", 10, 86400, "");
  table.set("command line", "--time", text);
  return s;
}

host::PolicyListing listing_of(const std::string& name, const std::string& plugin) {
  std::vector<std::string> names;
  std::vector<std::string> files;
  if (!plugin.empty()) files.push_back(plugin);
  for (const host::PolicyListing& p : host::list_policies(host::default_search_path(files))) {
    if (!p.broken.empty() || !p.shadowed_by.empty()) continue;
    if (p.id == name) return p;
    names.push_back(p.id);
  }
  const std::string near = core::nearest_name(name, names);
  throw InputError("policy", name,
                   "no plugin offers it" + (near.empty() ? "" : "; did you mean " + near + "?"));
}

tuning::TuneOptions options_of(const TuneArguments& args) {
  tuning::TuneOptions o = args.tune;
  o.search.method = tuning::search_method(args.method);
  o.policy = campaign::parse_contestant(args.policy);
  if (o.policy.plugin.empty()) o.policy.plugin = args.plugin;
  o.axes = tuning::axes_of(listing_of(o.policy.policy, o.policy.plugin), args.parameters);
  for (const auto& [key, value] : o.policy.parameters)  // parameters given by the user stay fixed
    std::erase_if(o.axes, [&key = key](const tuning::Axis& a) { return a.id == key; });
  if (o.axes.empty())
    throw InputError("karst tune", args.policy, "gives every parameter a value: none is left to tune");
  Campaign& c = o.campaign;
  c.source = "karst tune";
  c.metric = o.metric;
  c.profile = args.profile;
  c.mission = args.mission;
  c.flight_time_s = flight_time_of(args.flight_time);
  for (const std::string& s : args.settings) {
    const auto equals = s.find('=');
    if (equals == std::string::npos) throw InputError("--set", s, "expected key=value");
    c.overrides.emplace_back(s.substr(0, equals), s.substr(equals + 1));
  }
  for (std::int64_t s = 1; s <= args.seeds; ++s) c.seeds.push_back(s);
  for (const std::string& file : args.caves) c.caves.push_back(campaign::parse_cave(file));
  for (const std::string& file : args.held_out) o.held_out.push_back(campaign::parse_cave(file));
  return o;
}

std::string parameters_text(const campaign::Settings& parameters) {
  std::string out;
  for (const auto& [key, value] : parameters) out += (out.empty() ? "" : ", ") + key + " = " + value;
  return out;
}

void write_table(const fs::path& file, const TuneResult& r, const std::string& metric) {
  std::string text = "candidate";
  for (const auto& [key, value] : r.tried.front().parameters) text += "," + core::csv_cell(key);
  text += "," + core::csv_cell(metric) + "\n";
  for (std::size_t i = 0; i < r.tried.size(); ++i) {
    text += std::to_string(i);
    for (const auto& [key, value] : r.tried[i].parameters) text += "," + core::csv_cell(value);
    std::array<char, 32> number;
    std::snprintf(number.data(), number.size(), ",%.6g\n", r.tried[i].mean);
    text += number.data();
  }
  evaluation::write_whole_file(file, text);
}

/// The remark of the preset: its measured benefit, and the basis of that.
std::string worth_text(const TuneResult& r) {
  std::string out;
  if (r.tuned_on) out += "On the caves it was tuned on (which flatters it): " + r.tuned_on->sentence + "\n";
  if (r.held_out) out += "On caves held out: " + r.held_out->sentence + "\n";
  if (r.tuned_on && !r.held_out) out += "No cave was held out: nothing is known of other caves.\n";
  return out;
}

int finish(const TuneArguments& args, const tuning::TuneOptions& o, const TuneResult& r) {
  const fs::path folder = args.out;
  if (!r.tried.empty()) write_table(folder / "tune.csv", r, o.metric);
  if (r.stopped) {
    print_error("karst: stopped after %s; the same command goes on where it was\n",
                core::counted(r.tried.size(), "candidate").c_str());
    return kInterrupted;
  }
  if (r.best == 0) {
    print_out("None of %zu candidates did better than the default; no preset is written.\n",
              r.tried.size() - 1);
    return 0;
  }
  const tuning::Candidate& best = r.tried[r.best];
  selection::PolicyPreset preset{o.policy.policy, {}};
  for (const auto* settings : {&o.policy.parameters, &best.parameters})
    for (const auto& [key, value] : *settings)
      preset.parameters.push_back({key, boost::property_tree::ptree(value)});
  const std::string worth = worth_text(r);
  evaluation::write_whole_file(
      folder / "preset.info",
      selection::to_info(preset, "karst tune " + args.policy + ", by " + o.metric + "\n" + worth));
  print_out("Best of %zu candidates: %s\n%sLook next at:\n", r.tried.size(),
            parameters_text(best.parameters).c_str(), worth.c_str());
  print_out("  karst fly --preset %s --cave FILE\n", (folder / "preset.info").c_str());
  print_out("  %s   all candidates\n", (folder / "tune.csv").c_str());
  if (r.held_out)
    print_out("  karst results %s   the flights through caves held out\n", (folder / "held_out").c_str());
  return 0;
}

/// Throws what is wrong with the caves held out, which are flown last.
void check_held_out(const tuning::TuneOptions& o, const fs::path& karst) {
  if (o.held_out.empty()) return;
  Campaign c = o.campaign;
  c.name = "held_out";
  c.caves = o.held_out;
  c.contestants = {o.policy};
  campaign::complete(c);
  campaign::make_plan(c, karst, {});
}

int tune(const TuneArguments& args) {
  flight::refuse_run(args.out);
  if (fs::exists(fs::path(args.out) / "campaign.sqlite"))
    throw InputError(args.out, "campaign.sqlite", "is that of a campaign; choose another --out");
  const tuning::TuneOptions o = options_of(args);
  const std::size_t candidates = tuning::candidates_of(o);
  const fs::path karst = fs::read_symlink("/proc/self/exe");
  check_held_out(o, karst);
  if (!args.quiet)
    print_error("%s, %s through %s with %s\n", core::counted(o.axes.size(), "parameter").c_str(),
                core::counted(candidates, "candidate").c_str(),
                core::counted(o.campaign.caves.size(), "cave").c_str(),
                core::counted(o.campaign.seeds.size(), "seed").c_str());
  const std::atomic<bool>& interrupted = watch_for_interrupt();
  const tuning::Fly fly = [&](const Campaign& wanted,
                              const std::string& name) -> std::optional<campaign::CampaignResults> {
    Campaign c = wanted;
    c.name = name;
    campaign::complete(c);
    campaign::RunOptions run;
    run.folder = fs::path(args.out) / name;
    run.karst = karst;
    run.jobs = args.jobs;
    run.keep = campaign::Keep::figures;
    run.binaries = args.any_binary ? campaign::AcceptedBinaries::any : campaign::AcceptedBinaries::same;
    run.stop = &interrupted;
    if (interrupted || !campaign::run_campaign(c, run)) return std::nullopt;
    return campaign::read_results(run.folder);
  };
  std::size_t n = 0;
  tuning::TuneEvents events;
  events.tried = [&](const tuning::Candidate& tried, std::size_t of) {
    if (!args.quiet)
      print_error("%3zu of %zu  %s %.4g  %s\n", ++n, of, o.metric.c_str(), tried.mean,
                  parameters_text(tried.parameters).c_str());
  };
  return finish(args, o, tuning::tune(o, fly, events));
}

}  // namespace

void add_tune_command(CLI::App& app) {
  auto args = std::make_shared<TuneArguments>();
  CLI::App* tune_app = app.add_subcommand(
      "tune",
      "Find better parameters for a policy by flying it, and say what they are worth in caves it was not "
      "tuned on\n\n"
      "  karst tune unknown_ratio --caves a.info b.info --held-out c.info d.info --flights 120 --out "
      "runs/tuned\n"
      "  karst tune unknown_ratio:goals=4 --parameter ratio_worth --parameter half_edge --caves a.info --out "
      "runs/t\n\n"
      "Writes OUT/preset.info (karst fly --preset), OUT/tune.csv and the flights' stores. Started again with "
      "the same "
      "words it goes on where it was stopped or killed.\nExit code: 0 done, 130 stopped, 1 otherwise.");
  tune_app->add_option("policy", args->policy, "the policy; policy:key=value,... keeps these as given")
      ->type_name(kPolicy)
      ->required()
      ->check(not_empty());
  tune_app->add_option("--caves", args->caves, "cave .info files to tune on")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  tune_app->add_option("--held-out", args->held_out, "cave .info files that only judge what came of it")
      ->type_name(kFile)
      ->check(not_empty());
  tune_app->add_option("--parameter", args->parameters, "a parameter to tune; default: all that are numbers")
      ->allow_extra_args(false)
      ->check(not_empty());
  tune_app->add_option("--metric", args->tune.metric, "the figure to do better in")
      ->type_name(kMetric)
      ->capture_default_str();
  tune_app->add_option("--seeds", args->seeds, "seeds in each cave, the same for all candidates")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  tune_app->add_option("--flights", args->tune.flights, "how many flights it may take in all")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  tune_app
      ->add_option("--method", args->method, "bobyqa, direct, crs (" + core::doc_path("docs/tune.md") + ")")
      ->capture_default_str();
  tune_app->add_option("--time", args->flight_time, "flight time, such as \"300 s\"")->capture_default_str();
  tune_app->add_option("--profile", args->profile, "as of karst compare")->capture_default_str();
  tune_app->add_option("--mission", args->mission, "mission file with settings that all share")
      ->type_name(kFile)
      ->check(not_empty());
  tune_app->add_option("--set", args->settings, "key=value for all; see karst fly --keys")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  tune_app->add_option("--plugin", args->plugin, "file with policies (.so or .py) to look in first")
      ->type_name(kFile)
      ->check(not_empty());
  tune_app->add_option("--out", args->out, "folder for the preset, the table and the stores")
      ->type_name(kFolder)
      ->required()
      ->check(not_empty())
      ->check(no_file());
  tune_app->add_option("--jobs", args->jobs, "flights at once; default: one a core")
      ->check(CLI::Range(1, 4096));
  tune_app->add_flag("--any-binary", args->any_binary,
                     "go on although karst or a plugin is another one than before");
  tune_app->add_flag("--quiet", args->quiet, "no progress");
  tune_app->callback([args] {
    if (const int code = tune(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
