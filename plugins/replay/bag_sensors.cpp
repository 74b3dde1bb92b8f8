#include "plugins/replay/bag_sensors.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "plugins/replay/sweep_of_scan.h"

namespace karst::replay {
namespace {

using core::InputError;
using core::TimeNs;
namespace fs = std::filesystem;

// IMU samples usually come before the scan that they lie in. A topic that ends early must not queue the other
// one whole.
constexpr std::size_t kMaxScansAhead = 10, kMaxSamplesAhead = 1'000'000;

bool is_pose_type(std::string_view type) {
  return type == "nav_msgs/Odometry" || type == "geometry_msgs/PoseStamped";
}
InputError no_poses(const std::string& path, const std::string& topic) {
  return {path, "topic " + topic,
          "has no nav_msgs/Odometry or geometry_msgs/PoseStamped, which bag.truth asks for"};
}

/// What is missing may lie where the bag is damaged.
std::string damage_text(const FaultLog& faults) {
  if (faults.count() == 0) return "";
  std::string text = " The bag is damaged:";
  for (std::size_t i = 0; i < std::min<std::size_t>(faults.first().size(), 3); ++i)
    text += (i == 0 ? " " : "; ") + faults.first()[i].place + ": " + faults.first()[i].reason;
  return text + (faults.count() > 3 ? "; and " + std::to_string(faults.count() - 3) + " more." : ".");
}

}  // namespace

BagRecording open_bag_recording(const std::string& path, const std::string& info_file) {
  BagRecording r;
  r.path = path;
  r.info_file = info_file;
  const fs::path named = fs::is_directory(path) ? fs::path(path) / "recording" : fs::path(path);
  const fs::path beside = fs::path(named).replace_extension(".info");
  if (info_file.empty() && fs::exists(beside)) r.info_file = beside.string();
  RecordingInfo given;
  if (!r.info_file.empty()) try {
      given = read_recording_info(r.info_file);
    } catch (const InputError& e) {
      if (!info_file.empty()) throw;
      throw InputError(e, " (read because it stands beside the bag; --info names another)");
    }
  const BagSurvey survey = survey_bag(path, SurveyExtent::beginning, given.fields);
  RecordingGuess guess =
      guess_recording(survey, given, r.info_file.empty() ? std::set<std::string>{} : keys_in(r.info_file));
  if (!guess.doubts.empty()) {
    std::string all;
    for (const std::string& d : guess.doubts) all += (all.empty() ? "" : " ") + d;
    throw InputError(path, "", all + damage_text(survey.faults) + " See karst recording info.");
  }
  // What the file says goes before what was guessed.
  r.info = r.info_file.empty() ? guess.info : read_recording_info(r.info_file, guess.info);
  if (r.info.lidar_topic == "auto") r.info.lidar_topic = guess.info.lidar_topic;
  if (r.info.imu_topic == "auto") r.info.imu_topic = guess.info.imu_topic;
  if (r.info.truth_topic != "none") {
    const auto& topics = survey.topics;
    if (std::none_of(topics.begin(), topics.end(), [&](const TopicFacts& t) {
          return t.topic == r.info.truth_topic && is_pose_type(t.type);
        }))
      throw no_poses(path, r.info.truth_topic);
  }
  const std::string& said_by = r.info_file.empty() ? path : r.info_file;
  check_recording_info(r.info, said_by);
  r.layout = layout_of(r.info, said_by);
  r.assumptions = std::move(guess.grounds);
  return r;
}

BagSensors::BagSensors(BagRecording recording)
    : recording_(std::move(recording)), bag_(open_bag(recording_.path)), decoder_(bag_->connections()) {
  std::vector<bool> wanted;
  for (const Connection& c : bag_->connections())
    wanted.push_back((c.topic == recording_.info.lidar_topic && is_cloud_type(c.type)) ||
                     (c.topic == recording_.info.imu_topic && c.type == "sensor_msgs/Imu"));
  bag_->select(std::move(wanted));
  ReadNotes notes;
  auto sweep = make_sweep(notes);
  if (!sweep)
    throw InputError(recording_.path, "topic " + recording_.info.lidar_topic, "has no scan that can be read");
  // The end of the sweep lies at least half a sweep after its stamp, or at it. Of absolute times, the stamps
  // may be of another clock, or none.
  const bool of_stamps_clock = sweep->stamp - notes.stamp < StampCheck<int>::kMaxJump;
  begin_ = (of_stamps_clock ? std::min(notes.stamp, sweep->stamp) : sweep->stamp) -
           core::from_seconds(recording_.info.period_s);
  first_.emplace(std::move(*sweep), notes);
}

bool BagSensors::read_one() {
  const auto m = bag_->next();
  if (!m) {
    const std::size_t before = clouds_.size() + imu_.size();
    queue(cloud_stamps_.finish());
    queue(imu_stamps_.finish());
    return clouds_.size() + imu_.size() > before;
  }
  try {
    if (bag_->connections()[m->connection].type == "sensor_msgs/Imu")
      take_imu(*m);
    else
      take_cloud(*m);
  } catch (const MalformedError& e) {
    faults_.add(text_of({m->connection, m->chunk_byte, m->byte}), e.what());
  }
  return true;
}

void BagSensors::take_cloud(const BagMessage& m) {
  CloudMessage cloud = cloud_of(bag_->connections()[m.connection].type,
                                decoder_.decode(m.connection, m.bytes), recording_.info.fields);
  const TimeNs stamp = cloud.stamp;
  queue(cloud_stamps_.take({{std::move(cloud), {m.connection, m.chunk_byte, m.byte}}, stamp, m.time},
                           imu_stamps_.shift()));
}

void BagSensors::take_imu(const BagMessage& m) {
  const core::ImuSample sample = imu_of(decoder_.decode(m.connection, m.bytes));
  queue(imu_stamps_.take({{sample, {m.connection, m.chunk_byte, m.byte}}, sample.stamp, m.time},
                         cloud_stamps_.shift()));
}

void BagSensors::queue(StampCheck<QueuedCloud>::Verdict clouds) {
  log(clouds);
  for (auto& [cloud, stamp, recorded] : clouds.passed) {
    cloud.shift = stamp - cloud.cloud.stamp;
    cloud.cloud.stamp = stamp;
    clouds_.push_back(std::move(cloud));
  }
}

void BagSensors::queue(StampCheck<QueuedSample>::Verdict samples) {
  log(samples);
  for (auto& [queued, stamp, recorded] : samples.passed) {
    queued.sample.stamp = stamp;
    queue(queued.sample, queued.place);
  }
}

void BagSensors::queue(core::ImuSample sample, const MessagePlace& place) {
  if (last_imu_ && sample.stamp < *last_imu_)
    return faults_.add(text_of(place), "its stamp " + decimal_seconds(sample.stamp) + " s goes back in time");
  last_imu_ = sample.stamp;
  constexpr double kStandardGravity = 9.80665;
  if (recording_.info.imu_force_unit == ForceUnit::g) sample.specific_force_mps2 *= kStandardGravity;
  sample.specific_force_mps2 = recording_.layout.R_body_imu * sample.specific_force_mps2;
  sample.body_rate_radps = recording_.layout.R_body_imu * sample.body_rate_radps;
  imu_.push_back(sample);
  if (imu_.size() > kMaxSamplesAhead) {
    imu_.pop_front();
    faults_.add(text_of(place), "a million samples came without a scan: the oldest are left out");
  }
}

template <class Verdict>
void BagSensors::log(const Verdict& verdict) {
  for (const auto& r : verdict.refused)
    faults_.add(text_of(r.value.place),
                "its stamp " + decimal_seconds(r.stamp) + " s jumps against the time of recording");
  if (verdict.set_by < 0)
    faults_.add(text_of(verdict.passed.front().value.place),
                core::format_text("the clock was set back by %.1f s: its later stamps are shifted by that",
                                  -core::seconds(verdict.set_by)));
  if (verdict.set_by > 0)
    faults_.add(text_of(verdict.passed.front().value.place),
                core::format_text("the clock was set forward by %.1f s", core::seconds(verdict.set_by)));
}

std::string BagSensors::text_of(const MessagePlace& place) const {
  return "topic " + bag_->connections()[place.connection].topic + ", byte " +
         std::to_string(place.chunk_byte) + ", message at " + std::to_string(place.byte) + " of it";
}

std::optional<core::Sweep> BagSensors::make_sweep(ReadNotes& notes) {
  for (;;) {
    while (clouds_.empty())
      if (!read_one()) return std::nullopt;
    QueuedCloud next = std::move(clouds_.front());
    clouds_.pop_front();
    notes = {next.cloud.stamp, 0, false};
    const std::string place = text_of(next.place);
    core::Sweep sweep;
    try {
      sweep = sweep_of(std::move(next.cloud.scan), next.cloud.stamp, {recording_.path, place},
                       recording_.info, recording_.layout, &notes);
    } catch (const InputError& e) {
      if (!last_sweep_) throw;  // the recording file is wrong rather than one scan
      faults_.add(place, std::string(e.what()).substr(recording_.path.size() + place.size() + 4));
      continue;
    }
    if (sweep.points.empty()) {
      ++without_returns_;
      continue;
    }
    if (recording_.info.time_of == TimeOrigin::absolute && !sweep.compensated) sweep.stamp += next.shift;
    if (last_sweep_ && sweep.stamp <= *last_sweep_) {
      faults_.add(place, "its last point is not after that of the scan before it");
      continue;
    }
    last_sweep_ = sweep.stamp;
    return sweep;
  }
}

std::optional<core::Sweep> BagSensors::next_sweep(ReadNotes& notes) {
  if (!first_) return make_sweep(notes);
  auto [sweep, of_sweep] = std::move(*first_);
  first_.reset();
  notes = of_sweep;
  return sweep;
}

std::optional<core::ImuSample> BagSensors::next_imu() {
  while (imu_.empty() && clouds_.size() < kMaxScansAhead)
    if (!read_one()) break;
  if (imu_.empty()) return std::nullopt;
  const core::ImuSample sample = imu_.front();
  imu_.pop_front();
  return sample;
}

SensorStream::Damage BagSensors::damage() const {
  Damage damage;
  for (const FaultLog* log : {&bag_->faults(), &faults_}) {
    for (const Fault& f : log->first())
      damage.first.push_back(recording_.path + ": " + f.place + ": " + f.reason);
    damage.count += log->count();
  }
  return damage;
}

WrittenTruth write_truth(const std::string& path, const std::string& topic, const std::string& tum_file) {
  const auto bag = open_bag(path);
  MessageDecoder decoder(bag->connections());
  std::vector<bool> wanted;
  for (const Connection& c : bag->connections()) wanted.push_back(c.topic == topic && is_pose_type(c.type));
  if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) throw no_poses(path, topic);
  bag->select(std::move(wanted));
  std::ofstream out(tum_file, std::ios::trunc);
  WrittenTruth written;
  std::string problem;  // of the first that is damaged
  while (const auto m = bag->next()) {
    const std::string& type = bag->connections()[m->connection].type;
    try {
      const StampedPose pose = pose_of(type, decoder.decode(m->connection, m->bytes));
      const core::Vec3& p = pose.T_world_body.position;
      const core::Quat& q = pose.T_world_body.orientation;
      if (!p.allFinite()) throw MalformedError("its position is not finite", 0);
      std::array<char, 256> line;
      std::snprintf(line.data(), line.size(), "%s %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n",
                    decimal_seconds(pose.stamp).c_str(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
      out << line.data();
      ++written.poses;
    } catch (const MalformedError& e) {
      if (written.damaged++ == 0) problem = e.what();
    }
  }
  out.flush();
  if (!out) throw InputError(tum_file, "", "cannot be written");
  if (written.poses == 0)
    throw InputError(path, "topic " + topic,
                     "none of its " + std::to_string(written.damaged) +
                         " messages is a pose that can be read, which bag.truth asks for" +
                         (problem.empty() ? "" : ": " + problem));
  return written;
}

}  // namespace karst::replay
