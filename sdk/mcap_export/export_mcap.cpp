#include "sdk/mcap_export/export_mcap.h"

#include <iterator>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "sdk/evaluation/record/run_record.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/part_file.h"
#include "sdk/mcap_export/picture_topics.h"
#include "sdk/mcap_export/scan_topics.h"

namespace karst::mcap {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using evaluation::RunRecord;

RunRecord run_of(const fs::path& directory) {
  RunRecord run = evaluation::read_run(directory);
  if (!run.estimate.empty()) return run;
  const fs::path file = directory / "trajectory.tum";
  if (fs::exists(directory / "team.jsonl"))
    throw InputError(file.string(), "",
                     "is not there: this is a team's run; export one of its robots, such as " +
                         (directory / "robot_1").string());
  throw InputError(
      file.string(), "",
      fs::exists(file) ? "holds no pose: nothing was flown" : "is not there: this is no run directory");
}

std::map<std::string, std::string> made_by(const RunRecord& run, const FlightClock& clock,
                                           const std::string& version) {
  std::map<std::string, std::string> out = {
      {"exported_by", "karst " + version},
      {"run", fs::absolute(run.directory).lexically_normal().filename().string()},
      {"epoch_s", core::shortest_text(core::seconds(clock.epoch))}};
  for (const char* key :
       {"karst.version", "policy.name", "policy.version", "cave.file", "seed", "map.resolution"})
    if (std::string value = run.setting(key); !value.empty()) out[key] = std::move(value);
  return out;
}

void append(std::vector<Topic>& topics, std::vector<Topic> more) {
  topics.insert(topics.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

McapExport export_mcap(const fs::path& directory, const fs::path& file, std::optional<core::TimeNs> epoch,
                       const std::string& version) {
  const RunRecord run = run_of(directory);
  std::vector<std::string> problems = run.problems;
  const double recorded_s = run.number("replay.time_origin").value_or(0);
  const FlightClock clock{epoch.value_or(core::from_seconds(recorded_s))};
  std::vector<Topic> topics = pose_topics(run, clock);
  append(topics, map_topics(run, clock, problems));
  append(topics, event_topics(run, clock));
  topics.push_back(battery_topic(run, clock));
  append(topics, picture_topics(run, clock, problems));
  append(topics, scan_topics(run, clock, problems));

  PartFile part(file);
  McapWriter writer(part.stream(), {.profile = "ros2", .library = "karst " + version});
  if (const auto settings = recorded_settings(run); !settings.empty())
    writer.metadata(replay::kRecordedSettings, settings);  // first, so that a file that is cut has it
  McapExport out;
  out.topics = write_topics(writer, std::move(topics));
  // The profiles of quality of service are numbers, as Humble writes them. A later rosbag2 expects words,
  // unless the file says so.
  writer.metadata("rosbag2", {{"ROS_DISTRO", "humble"}});
  writer.metadata("karst", made_by(run, clock, version));
  writer.finish();
  part.commit();
  out.messages = writer.messages();
  out.bytes = writer.bytes();
  out.duration_s = run.last_time_s();
  out.epoch = clock.epoch;
  out.problems = std::move(problems);
  return out;
}

}  // namespace karst::mcap
