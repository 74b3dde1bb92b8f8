#include "sdk/tools/recording_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "plugins/replay/recording_guess.h"
#include "plugins/replay/recording_source.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"

namespace karst::tools {
namespace {

struct RecordingArguments {
  std::string file;
  bool json = false;
};

const char* name_of_encoding(replay::Encoding e) {
  return e == replay::Encoding::ros1 ? "ros1" : e == replay::Encoding::cdr ? "cdr" : "unknown";
}

nlohmann::ordered_json json_of(const replay::BagSurvey& survey, const replay::RecordingGuess& guess,
                               const std::string& file) {
  nlohmann::ordered_json j;
  j["schema"] = "karst.recording/1";
  j["file"] = file;
  j["begin"] = replay::decimal_seconds(survey.first);
  j["end"] = replay::decimal_seconds(survey.last);
  j["duration_s"] = core::seconds(survey.last - survey.first);
  j["topics"] = nlohmann::ordered_json::array();
  for (const auto& t : survey.topics)
    j["topics"].push_back({{"topic", t.topic},
                           {"type", t.type},
                           {"encoding", name_of_encoding(t.encoding)},
                           {"messages", t.messages},
                           {"bytes", t.bytes},
                           {"rate_hz", t.rate_hz()},
                           {"longest_gap_s", core::seconds(t.longest_gap)},
                           {"longest_gap_after", replay::decimal_seconds(t.gap_after)}});
  j["lidar"] = guess.lidar;
  j["grounds"] = guess.grounds;
  j["open"] = guess.doubts;
  j["recording_info"] = replay::recording_info_text(guess);
  j["faults"] = nlohmann::ordered_json::array();
  for (const auto& f : survey.faults.first())
    j["faults"].push_back({{"place", f.place}, {"reason", f.reason}});
  j["fault_count"] = survey.faults.count();
  return j;
}

void print_survey(const replay::BagSurvey& survey, const replay::RecordingGuess& guess) {
  // All but the keys are comments, so that the whole is a recording file.
  print_out("; %s s to %s s, %.1f s\n;\n", replay::decimal_seconds(survey.first).c_str(),
            replay::decimal_seconds(survey.last).c_str(), core::seconds(survey.last - survey.first));
  print_out("; %-30s %-32s %9s %9s %9s %12s\n", "topic", "type", "messages", "Hz", "MB", "longest gap");
  for (const auto& t : survey.topics)
    print_out("; %-30s %-32s %9zu %9.2f %9.2f %10.3f s\n", replay::comment_text(t.topic).c_str(),
              replay::comment_text(t.type).c_str(), t.messages, t.rate_hz(),
              static_cast<double>(t.bytes) * 1e-6, core::seconds(t.longest_gap));
  print_out(";\n%s", replay::recording_info_text(guess).c_str());
}

int show_recording(const RecordingArguments& args) {
  if (replay::holds_scan_files(args.file) && !replay::is_folder_of_bags(args.file))
    throw core::InputError(
        args.file, "",
        "is a folder of scans, not a bag: karst replay reads it, and takes what the scans do "
        "not say from recording.info in it");
  const replay::BagSurvey survey = replay::survey_bag(args.file, replay::SurveyExtent::all);
  const replay::RecordingGuess guess = replay::guess_recording(survey);
  if (args.json)
    print_json(json_of(survey, guess, args.file));
  else
    print_survey(survey, guess);
  if (survey.faults.count() == 0) return 0;
  for (const auto& f : survey.faults.first())
    print_error("karst: %s: %s: %s\n", args.file.c_str(), f.place.c_str(), f.reason.c_str());
  if (survey.faults.count() > survey.faults.first().size())
    print_error("karst: and %zu more like these\n", survey.faults.count() - survey.faults.first().size());
  return 1;
}

}  // namespace

void add_recording_command(CLI::App& app) {
  CLI::App* recording = app.add_subcommand("recording", "Look into recordings of a real vehicle's sensors");
  recording->require_subcommand(1);
  auto args = std::make_shared<RecordingArguments>();
  CLI::App* info = recording->add_subcommand(
      "info",
      "Say what a bag contains, and what karst replay would assume of it\n\n"
      "  karst recording info flight7.bag\n"
      "  karst recording info flight7.mcap --json\n\n"
      "Topics with their types, rates and gaps; the kind of the LiDAR, with the evidence; and a recording "
      "file for karst replay --info (" +
          core::doc_path("docs/replay.md") + ").\nExit code: 0 read, 1 damaged or an error.");
  info->add_option("file", args->file, "bag of ROS 1 (.bag) or ROS 2 (.mcap, .db3)")
      ->type_name(kFile)
      ->required()
      ->check(not_empty());
  info->add_flag("--json", args->json, "print one JSON object");
  info->callback([args] {
    if (const int code = show_recording(*args); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace karst::tools
