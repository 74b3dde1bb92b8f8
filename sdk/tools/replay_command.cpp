#include "sdk/tools/replay_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/property_tree/info_parser.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/printable.h"
#include "plugins/replay/bag_sensors.h"
#include "plugins/replay/recording_source.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "sdk/flight/finish_run.h"
#include "sdk/flight/run_files.h"
#include "sdk/replay/replay_run.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/interrupt.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
namespace pt = boost::property_tree;

struct ReplayArguments {
  std::string scans, out, info;
  std::vector<std::string> settings;
  bool json = false, quiet = false, no_report = false, keys = false;
};

/// One line that is rewritten on a terminal, otherwise one line every hundred scans. If loops were closed,
/// the scans come a second time.
class ReplayLine {
 public:
  ReplayLine(bool quiet, std::optional<std::size_t> scans) : quiet_(quiet), scans_(scans) {}
  void show(std::size_t scan, const core::LoamPose& pose, const core::VoxelMap& map) {
    if (quiet_) return;
    if (scan <= last_) begin_again();
    last_ = scan;
    if (!terminal_ && scan % 100 != 0) return;
    const core::Vec3& p = pose.T_world_body.position;
    std::string details;
    if (!again_) details = std::to_string(pose.edges + pose.planes) + " features  ";
    std::fprintf(stderr, "%s%sscan %zu%s  at (%.1f, %.1f, %.1f)  %s%.0f m³ free  %s%s",
                 terminal_ ? "\r\033[K" : "", again_ ? "mapped again: " : "", scan,
                 scans_ ? (" of " + std::to_string(*scans_)).c_str() : "", p.x(), p.y(), p.z(),
                 details.c_str(), map.free_volume_m3(),
                 pose.valid ? "" : ("lost: " + core::printable(pose.problem)).c_str(), terminal_ ? "" : "\n");
  }
  void end() const {
    if (!quiet_ && terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  void begin_again() {
    again_ = true;
    scans_ = last_;
    end();
    std::fprintf(stderr,
                 "Loops were closed: all scans are read again, and mapped at their corrected poses.\n");
  }

  bool quiet_, terminal_ = isatty(STDERR_FILENO) == 1, again_ = false;
  std::optional<std::size_t> scans_;
  std::size_t last_ = 0;
};

core::OptionTable table_of(replay::ReplayOptions& options) {
  core::OptionTable table;
  describe(table, options);
  return table;
}

replay::ReplayOptions options_of(const ReplayArguments& args) {
  replay::ReplayOptions options;
  core::OptionTable table = table_of(options);
  for (const std::string& s : args.settings) {
    const auto equals = s.find('=');
    if (equals == std::string::npos)
      throw core::InputError("--set", s, "expected key=value, such as map.resolution=\"0.3 m\"");
    table.set("--set", s.substr(0, equals), s.substr(equals + 1));
  }
  return options;
}

/// All resolved settings, and the recording's own description.
void write_settings(const fs::path& run_dir, const replay::RecordingSource& recording,
                    replay::ReplayOptions options) {
  pt::ptree tree = table_of(options).resolved();
  core::OptionTable declared;
  replay::RecordingInfo info = recording.info;
  describe(declared, info);
  tree.put_child("recording", declared.resolved());
  const core::TimeNs origin = recording.sensors->begin();
  tree.put("replay.scans", fs::absolute(recording.path).lexically_normal().string());
  tree.put("replay.info", recording.info_file);
  tree.put("replay.time_origin", replay::decimal_seconds(origin));
  tree.put("karst.version", KARST_VERSION);
  const fs::path file = run_dir / "mission.info";
  try {
    pt::write_info(file.string(), tree);
  } catch (const pt::info_parser_error& e) {
    throw core::InputError(file.string(), "", e.message());
  }
}

void print_summary(const replay::ReplaySummary& s, std::size_t without_returns, const nlohmann::json& metrics,
                   const fs::path& run_dir, bool report) {
  print_out("%zu scans, %zu of them lost", s.scans, s.lost);
  if (s.lost > 0) print_out(" (the last: %s)", s.last_problem.c_str());
  print_out("\n  points           %zu used, %zu left out (not finite, or out of range)\n", s.points,
            s.dropped_points);
  if (without_returns > 0) print_out("  skipped          %zu scans without a return\n", without_returns);
  if (s.imu_samples > 0) print_out("  IMU              %zu samples\n", s.imu_samples);
  print_out("  path length      %.2f m\n", s.path_m);
  if (metrics["explored_volume_m3"].is_number())
    print_out("  free volume      %.0f m³\n", metrics["explored_volume_m3"].get<double>());
  if (s.degenerate > 0) print_out("  degenerate       %zu scans left a direction free\n", s.degenerate);
  if (s.scans > 0)
    print_out("  localization     %.1f ms a scan, %.1f ms at most\n",
              1e3 * s.localization_s / static_cast<double>(s.scans), 1e3 * s.slowest_s);
  if (const replay::LoopSummary& l = s.loops; l.closed > 0)
    print_out("  loops            %zu closures; positions corrected by up to %.2f m%s\n", l.closed,
              l.largest_correction_m, l.mapped_again ? "" : " (stopped: not applied)");
  if (s.loops.submaps > 0 && s.loops.path_m > 0)
    print_out("  search for loops %.1f s, %.2f s at most after a scan; %zu submaps, %.1f MB a km\n",
              s.loops.search_s, s.loops.slowest_s, s.loops.submaps,
              1e-3 * static_cast<double>(s.loops.bytes) / s.loops.path_m);
  if (s.without_times)
    print_out(
        "note: the points have no times, so motion during a scan was not compensated; see time.direction and "
        "compensated in %s\n",
        core::doc_path("docs/replay.md").c_str());
  print_out("Look next at:\n");
  if (report) print_out("  %s   the map in 3D; open it in a browser\n", (run_dir / "report.html").c_str());
  print_out("  %s   the trajectory (TUM); karst evaluate %s --truth FILE\n",
            (run_dir / "trajectory.tum").c_str(), run_dir.c_str());
}

void print_damage(const replay::SensorStream::Damage& damage) {
  for (const std::string& d : damage.first) print_error("karst: %s\n", core::printable(d).c_str());
  if (damage.count > damage.first.size())
    print_error("karst: and %zu more like these\n", damage.count - damage.first.size());
  print_error("karst: the bag is damaged; what could be read of it was replayed\n");
}

int replay_scans(const ReplayArguments& args) {
  if (args.keys) {
    replay::ReplayOptions options;
    replay::RecordingInfo info;
    core::OptionTable declared;
    describe(declared, info);
    print_out("Keys for --set:\n%s\nKeys of recording.info:\n%s", table_of(options).help().c_str(),
              declared.help().c_str());
    return 0;
  }
  if (args.scans.empty() || args.out.empty())
    throw core::InputError("karst replay", "", "needs SCANS and --out DIR; see karst replay --help");
  const replay::ReplayOptions options = options_of(args);
  const replay::RecordingSource recording = replay::open_source(args.scans, args.info);
  if (!args.quiet && !args.json)
    for (const std::string& a : recording.assumptions)
      std::fprintf(stderr, "%s\n", core::printable(a).c_str());

  const std::atomic<bool>& interrupted = watch_for_interrupt();
  const fs::path run_dir = flight::run_dir_of(args.out);
  flight::RunClaim claim(run_dir);
  std::error_code error;
  fs::create_directories(run_dir, error);
  if (error)
    throw core::InputError(run_dir.string(), "", "the run directory cannot be made: " + error.message());
  write_settings(run_dir, recording, options);
  claim.keep();

  replay::ReplaySummary summary;
  replay::WrittenTruth truth;
  std::string damage;
  ReplayLine line(args.quiet || args.json, recording.sensors->scans());
  try {
    if (recording.is_bag && recording.info.truth_topic != "none")
      truth =
          replay::write_truth(recording.path, recording.info.truth_topic, (run_dir / "truth.tum").string());
    summary = replay::replay_recording(
        *recording.sensors, options, run_dir,
        [&](std::size_t scan, const core::LoamPose& pose, const core::VoxelMap& map) {
          line.show(scan, pose, map);
          return !interrupted;
        },
        [&] { return std::move(replay::open_source(args.scans, args.info).sensors); });
  } catch (const core::InputError& e) {
    damage = e.what();
  }
  line.end();
  const nlohmann::json metrics =
      flight::finish_run(run_dir, {"", "", args.no_report ? flight::Report::none : flight::Report::written});
  if (!damage.empty()) {
    print_error("karst: %s\nkarst: what came before it stands in %s\n", damage.c_str(), run_dir.c_str());
    return 1;
  }
  if (args.json) {
    print_json(metrics);
  } else {
    print_summary(summary, recording.sensors->scans_without_returns(), metrics, run_dir, !args.no_report);
  }
  if (truth.damaged > 0)
    print_error(
        "karst: %s: topic %s: %zu of its messages are no poses that can be read; truth.tum has the other "
        "%zu\n",
        core::printable(recording.path).c_str(), core::printable(recording.info.truth_topic).c_str(),
        truth.damaged, truth.poses);
  if (const replay::SensorStream::Damage d = recording.sensors->damage(); d.count > 0) {
    print_damage(d);
    return 1;
  }
  if (truth.damaged > 0) return 1;
  return interrupted || summary.lost == summary.scans ? 2 : 0;
}

}  // namespace

void add_replay_command(CLI::App& app) {
  auto args = std::make_shared<ReplayArguments>();
  CLI::App* command = app.add_subcommand(
      "replay",
      "Localize and map from recorded scans (ROS bags, MCAP, PCD, PLY, bare .bin), with an IMU where there "
      "is one\n\n"
      "  karst replay scans/kitti00 --info kitti.info --out runs/kitti00\n"
      "  karst replay flight7 --out runs/flight7 --set map.resolution=\"0.3 m\"\n"
      "  karst replay flight8.mcap --out runs/flight8\n"
      "  karst replay --keys\n\n"
      "SCANS is a bag (.bag, .mcap, .db3) or a folder. Of a bag, karst finds the sensors and says what it "
      "assumed; "
      "FILE.info beside it, or --info, overrides that. In a folder, a small file recording.info in it, or "
      "--info, declares what the files do not say: "
      "stamps, layout, units, frames, rings (" +
          core::doc_path("docs/replay.md") +
          ").\n"
          "Exit code: 0 replayed, 2 stopped by the operator or no scan could be placed, 1 an error.");
  command->add_option("scans", args->scans, "folder of scans, or a bag")
      ->type_name(kFile)
      ->check(not_empty());
  command->add_option("--out,-o", args->out, "run directory")->type_name(kFolder)->check(not_empty());
  command
      ->add_option("--info", args->info, "what the files do not say; default: recording.info in the folder")
      ->type_name(kFile)
      ->check(not_empty());
  command->add_option("--set", args->settings, "key=value; see --keys")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  command->add_flag("--json", args->json, "print metrics.json instead of a summary; no progress");
  command->add_flag("--quiet", args->quiet, "no progress");
  command->add_flag("--no-report", args->no_report, "no report.html");
  command->add_flag("--keys", args->keys, "list every key and end");
  command->callback([args] {
    if (const int code = replay_scans(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
