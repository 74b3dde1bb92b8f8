#include "sdk/tools/compare_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/paper/paper.h"
#include "sdk/campaign/plan/campaign.h"
#include "sdk/campaign/plan/flight_times.h"
#include "sdk/campaign/report/campaign_page.h"
#include "sdk/campaign/report/verdict_json.h"
#include "sdk/campaign/run/run_campaign.h"
#include "sdk/campaign/run/slurm_batch.h"
#include "sdk/campaign/store/export.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/flight/run_files.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/campaign_progress.h"
#include "sdk/tools/interrupt.h"
#include "sdk/tools/results_text.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using campaign::Campaign;
using core::InputError;

struct CompareArguments {
  std::vector<std::string> who, caves, settings, plugins, sbatch;
  std::string out, profile, mission, executor = "local", keep = "replay", metric;
  std::string flight_time, trial_timeout;
  std::int64_t seeds = 0;
  std::size_t batch = 0;
  std::size_t jobs = std::max(1u, std::thread::hardware_concurrency());
  bool quiet = false, any_binary = false;
};

double seconds_of(const std::string& option, const std::string& text, double low, double high) {
  double s = 0;
  core::OptionTable table;
  table.add(option, s, "s", low, high, "");
  table.set("command line", option, text);
  return s;
}

/// A campaign's folder determines what is flown: refuses further arguments, which would have no effect.
void refuse_beside_folder(const CompareArguments& args) {
  const std::pair<const char*, bool> given[] = {{"--seeds", args.seeds > 0},
                                                {"--time", !args.flight_time.empty()},
                                                {"--profile", !args.profile.empty()},
                                                {"--mission", !args.mission.empty()},
                                                {"--set", !args.settings.empty()},
                                                {"--plugin", !args.plugins.empty()},
                                                {"--trial-timeout", !args.trial_timeout.empty()},
                                                {"--out", !args.out.empty()}};
  for (const auto& [option, is_given] : given)
    if (is_given)
      throw InputError(args.who.front(), option,
                       "a campaign's folder goes on as it began; to append seeds or contestants, give the "
                       "campaign file or the policies again");
}

/// Applies options of the command line that override, or replace, a campaign file.
void apply(const CompareArguments& args, Campaign& c) {
  if (!args.profile.empty()) c.profile = args.profile;
  if (!args.mission.empty()) c.mission = args.mission;
  if (!args.metric.empty()) c.metric = args.metric;
  if (!args.flight_time.empty()) c.flight_time_s = seconds_of("--time", args.flight_time, 10, 86400);
  if (!args.trial_timeout.empty())
    c.trial_timeout_s = seconds_of("--trial-timeout", args.trial_timeout, 1, 1e7);
  if (args.seeds > 0) {
    c.seeds.clear();
    for (std::int64_t s = 1; s <= args.seeds; ++s) c.seeds.push_back(s);
  }
  for (const std::string& setting : args.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError("--set", setting, "expected key=value, such as motion.max_speed=1.5");
    c.overrides.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
}

/// `karst compare A B --caves FILE... --seeds N`.
Campaign from_words(const CompareArguments& args) {
  Campaign c;
  for (const std::string& who : args.who) c.contestants.push_back(campaign::parse_contestant(who));
  for (campaign::ContestantSpec& who : c.contestants)
    if (who.plugin.empty() && !args.plugins.empty()) who.plugin = args.plugins.front();
  for (const std::string& cave : args.caves) c.caves.push_back(campaign::parse_cave(cave));
  for (std::int64_t s = 1; s <= 10; ++s) c.seeds.push_back(s);
  apply(args, c);
  c.name.clear();
  for (const campaign::ContestantSpec& who : c.contestants)
    c.name += (c.name.empty() ? "" : "-vs-") + who.policy;
  if (c.name.size() > 60) c.name.resize(60);
  campaign::complete(c);
  return c;
}

Campaign from_file(const CompareArguments& args) {
  if (!args.plugins.empty())
    throw InputError(args.who.front(), "--plugin", "is given by contestant.plugin in a campaign file");
  Campaign c = campaign::read_campaign(args.who.front());
  apply(args, c);
  campaign::complete(c);
  return c;
}

/// Warns, before the first flight, about results that no flight could show.
void print_too_few(const campaign::Plan& plan) {
  const std::size_t caves = plan.caves.size(), pairs = caves * plan.seeds.size(),
                    least = campaign::min_pairs(plan.contestants.size(), campaign::VerdictOptions{}.alpha);
  if (pairs >= least) return;
  print_error(
      "karst: no difference can be shown by this campaign, whatever it finds: the test of %zu "
      "contestants needs %zu pairs of flights, and these are %zu; fly %zu seeds at least\n",
      plan.contestants.size(), least, pairs, (least + caves - 1) / caves);
}

/// Warns, before the first flight, about flights too short to explore in.
void print_too_short(const campaign::Plan& plan) {
  const std::string warning = campaign::little_exploration_text(plan);
  if (!warning.empty()) print_wrapped(stderr, 7, "karst: %s\n", warning.c_str());
}

/// A campaign file says by itself what flies where.
void refuse_file_among_policies(const CompareArguments& args) {
  for (const std::string& who : args.who) {
    const std::string ending = fs::path(who).extension().string();
    const bool is_policy = ending == ".py" || ending == ".so";
    if (ending == ".info" || (!is_policy && campaign::is_campaign(who)))
      throw InputError(who, "",
                       "is a campaign's file or folder, which stands alone: give it without further "
                       "policies and without --caves");
  }
}

int compare(const CompareArguments& args) {
  if (!args.metric.empty()) check_metric(args.metric);
  std::optional<Campaign> c;
  campaign::RunOptions options;
  options.folder = args.out;
  if (!args.caves.empty() || args.who.size() != 1) refuse_file_among_policies(args);
  if (!args.caves.empty()) {
    c = from_words(args);
  } else if (args.who.size() != 1) {
    throw InputError("karst compare", "",
                     "policies to compare need --caves FILE...; see karst compare --help");
  } else if (fs::is_directory(args.who.front())) {
    refuse_beside_folder(args);
    options.folder = args.who.front();  // resumes the campaign there
  } else if (!fs::exists(args.who.front())) {
    throw InputError(args.who.front(), "",
                     "no such campaign file or folder; policies to compare need --caves FILE...");
  } else {
    c = from_file(args);
  }
  if (options.folder.empty()) options.folder = fs::path("runs") / c->name;
  flight::refuse_run(options.folder);
  options.karst = fs::read_symlink("/proc/self/exe");
  options.executor = *core::parse<campaign::Where>(args.executor);
  options.sbatch = args.sbatch;
  options.batch = args.batch;
  options.jobs = args.jobs;
  options.keep = *core::parse<campaign::Keep>(args.keep);
  options.binaries = args.any_binary ? campaign::AcceptedBinaries::any : campaign::AcceptedBinaries::same;
  options.stop = &watch_for_interrupt();

  bool done = false;
  {
    CampaignProgress progress(args.quiet, args.jobs);
    bool told = false;
    options.progress = [&](const campaign::Plan& plan, const campaign::Progress& p) {
      if (!std::exchange(told, true)) {
        print_too_few(plan);
        print_too_short(plan);
      }
      progress.show(plan, p);
    };
    options.say = [&](const std::string& text) { progress.say(text); };
    done = campaign::run_campaign(c, options);
  }
  if (!done) {
    print_error("karst: stopped; karst compare %s goes on where it was\n", options.folder.c_str());
    return kInterrupted;
  }
  const campaign::CampaignResults results = campaign::read_results(options.folder);
  print_results(results, args.metric);
  print_out("Look next at:\n  %s   the report\n",
            campaign::write_campaign_page(options.folder, args.metric).c_str());
  print_out("  karst results %s --csv results.csv   every trial in a line\n", options.folder.c_str());
  print_out("  sqlite3 %s   the store\n", campaign::store_file(options.folder).c_str());
  return 0;
}

void write_to(const std::string& file, const std::function<void(std::ostream&)>& write) {
  if (file == "-") return write(std::cout);
  std::ostringstream out;
  write(out);
  evaluation::write_whole_file(file, out.str());
}

void write_paper_files(const std::string& from, const std::string& folder, campaign::PaperOptions options) {
  if (!options.metric.empty()) check_metric(options.metric);
  if (const char* path = std::getenv("PATH")) options.search_path = path;
  const campaign::PaperFiles files = campaign::write_paper(from, folder, options);
  for (const fs::path& file : files.written) print_out("%s\n", file.c_str());
  if (!files.with_pdf)
    print_wrapped(
        stderr, 7,
        "karst: no PDF of the figures: rsvg-convert is not there; apt-get install librsvg2-bin, and "
        "write again with --force\n");
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App* compare_app = app.add_subcommand(
      "compare",
      "Fly policies through the same caves with the same seeds and say which is better, and how sure that "
      "is\n\n"
      "  karst compare CAMPAIGN.info\n"
      "  karst compare nearest_frontier highest_frontier --caves caves/*.info --seeds 30\n"
      "  karst compare nearest_frontier nearest_frontier:horizon=15m --caves maze.info --seeds 10\n"
      "  karst compare runs/CAMPAIGN                             goes on with one that was stopped\n\n"
      "Started again, it goes on where it was stopped or killed; more seeds and contestants may be "
      "appended.\nExit code: 0 all trials flown (failed ones are results), 130 stopped, 1 otherwise.");
  compare_app
      ->add_option("contestants", args->who,
                   "CAMPAIGN.info, a campaign's folder, or policies with --caves: names, or files such as "
                   "my_policy.py")
      ->type_name(kPolicyOrFile)
      ->required()
      ->check(not_empty());
  compare_app->add_option("--caves", args->caves, "cave .info files")->type_name(kFile)->check(not_empty());
  compare_app->add_option("--seeds", args->seeds, "how many seeds: 1, 2, 3 ...; default 10")
      ->check(CLI::Range(1, 100000));
  compare_app->add_option("--time", args->flight_time, "flight time, such as \"300 s\" (default) or 5min");
  compare_app->add_option("--profile", args->profile,
                          "campaign (default): without what costs time only; full");
  compare_app->add_option("--mission", args->mission, "mission file with settings that all share")
      ->type_name(kFile);
  compare_app->add_option("--set", args->settings, "key=value for all; see karst fly --keys")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  compare_app->add_option("--plugin", args->plugins, "file with policies (.so or .py) to look in first")
      ->type_name(kFile)
      ->allow_extra_args(false)
      ->expected(1);
  compare_app->add_option("--out", args->out, "the campaign's folder; default runs/NAME")
      ->type_name(kFolder)
      ->check(not_empty())
      ->check(no_file());
  compare_app->add_option("--jobs", args->jobs, "trials flown at once; default: one a core")
      ->check(CLI::Range(1, 4096));
  compare_app->add_option("--executor", args->executor, "where trials fly: local, slurm")
      ->check(CLI::IsMember(core::all_names<campaign::Where>()));
  compare_app
      ->add_option("--batch", args->batch,
                   "trials a Slurm task flies; default: as many as are ten seconds of work")
      ->check(CLI::Range(1, 100000));
  compare_app
      ->add_option("--sbatch", args->sbatch, "further option of sbatch, such as --sbatch=--partition=long")
      ->allow_extra_args(false);
  compare_app->add_option("--trial-timeout", args->trial_timeout,
                          "wall-clock time after which a trial counts as hung and failed; default 2 h");
  compare_app
      ->add_option("--keep", args->keep,
                   "what stays of a trial: figures; replay (default): all but map.ot and map.ply; all")
      ->check(CLI::IsMember(core::all_names<campaign::Keep>()));
  compare_app
      ->add_option("--metric", args->metric,
                   "figure that the verdict is about, decided before flying; default coverage_auc")
      ->type_name(kMetric);
  compare_app->add_flag("--any-binary", args->any_binary,
                        "go on although karst or a plugin is another one than before");
  compare_app->add_flag("--quiet", args->quiet, "no progress");
  compare_app->callback([args] {
    if (const int code = compare(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

void add_trials_command(CLI::App& app) {
  auto batch = std::make_shared<std::string>();
  CLI::App* trials_app =
      app.add_subcommand("trials", "Fly a batch of a campaign's trials: what a Slurm task does.");
  trials_app->group("");  // for internal use only
  trials_app->add_option("batch", *batch, "batch file")->required();
  trials_app->callback([batch] {
    if (!campaign::fly_batch(*batch, &watch_for_interrupt())) throw CLI::RuntimeError(kInterrupted);
  });
}

void add_results_command(CLI::App& app) {
  struct Arguments {
    std::string folder, csv, json, metric, paper;
    PairSentences pairs;
    bool force = false;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* results_app = app.add_subcommand(
      "results",
      "Say what a campaign found, also while it flies: verdicts, every trial as CSV or JSON, or what a paper "
      "needs\n\n"
      "  karst results runs/CAMPAIGN\n  karst results runs/CAMPAIGN --csv trials.csv --json trials.json\n"
      "  karst results runs/CAMPAIGN --paper paper             tables, figures and methods");
  results_app->add_option("campaign", args->folder, "a campaign's folder, or its store")
      ->type_name(kFile)
      ->required();
  CLI::Option* csv =
      results_app->add_option("--csv", args->csv, "write a line a trial; - for standard output")
          ->type_name(kFile)
          ->check(not_empty());
  CLI::Option* json = results_app->add_option("--json", args->json, "write everything; - for standard output")
                          ->type_name(kFile)
                          ->check(not_empty());
  results_app
      ->add_option("--metric", args->metric,
                   "figure that the verdict is about; default: as the campaign declared")
      ->type_name(kMetric);
  CLI::Option* all_pairs =
      results_app->add_flag("--pairs", args->pairs.all, "say the verdict on each pair in a sentence")
          ->excludes(csv)
          ->excludes(json);
  results_app->add_option("--pairs-of", args->pairs.of, "only on the pairs of this contestant")
      ->type_name("NAME")
      ->check(not_empty())
      ->excludes(all_pairs)
      ->excludes(csv)
      ->excludes(json);
  CLI::Option* paper = results_app
                           ->add_option("--paper", args->paper,
                                        "folder for tables (LaTeX, Markdown), figures (SVG, PDF) and methods")
                           ->type_name(kFolder)
                           ->check(not_empty())
                           ->check(no_file());
  results_app->add_flag("--force", args->force, "with --paper: overwrite files that are there")->needs(paper);
  results_app->callback([args] {
    if (!args->paper.empty()) {
      const auto if_there = args->force ? campaign::IfThere::overwrite : campaign::IfThere::refuse;
      write_paper_files(args->folder, args->paper, {args->metric, if_there, ""});
    }
    if (!args->paper.empty() && args->csv.empty() && args->json.empty()) return;
    const campaign::ResultsWithExtras all = campaign::read_with_extras(args->folder);
    if (!args->csv.empty())
      write_to(args->csv, [&](std::ostream& out) { campaign::write_csv(out, all.results, all.extras); });
    if (!args->json.empty())
      write_to(args->json, [&](std::ostream& out) {
        campaign::write_json(out, all.results, all.extras, campaign::verdict_json(all.results, args->metric));
      });
    if (args->csv.empty() && args->json.empty()) print_results(all.results, args->metric, args->pairs);
  });
}

}  // namespace karst::tools
