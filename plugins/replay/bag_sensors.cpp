#include "plugins/replay/bag_sensors.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
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
constexpr TimeNs kMaxStampJump = 10 * core::kSecond;
constexpr int kJumpsAccepted = 5;

std::string place_of_message(const Connection& c, const BagMessage& m) {
  return "topic " + c.topic + ", byte " + std::to_string(m.chunk_byte) + ", message at " +
         std::to_string(m.byte) + " of it";
}

bool is_pose_type(std::string_view type) {
  return type == "nav_msgs/Odometry" || type == "geometry_msgs/PoseStamped";
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
  if (!r.info_file.empty()) given = read_recording_info(r.info_file);
  const BagSurvey survey = survey_bag(path, SurveyExtent::beginning, given.fields);
  RecordingGuess guess =
      guess_recording(survey, given, r.info_file.empty() ? std::set<std::string>{} : keys_in(r.info_file));
  if (!guess.doubts.empty()) {
    std::string all;
    for (const std::string& d : guess.doubts) all += (all.empty() ? "" : " ") + d;
    throw InputError(path, "", all + " See karst recording info.");
  }
  // What the file says goes before what was guessed.
  r.info = r.info_file.empty() ? guess.info : read_recording_info(r.info_file, guess.info);
  if (r.info.lidar_topic == "auto") r.info.lidar_topic = guess.info.lidar_topic;
  if (r.info.imu_topic == "auto") r.info.imu_topic = guess.info.imu_topic;
  r.layout = layout_of(r.info, r.info_file.empty() ? path : r.info_file);
  r.assumptions = std::move(guess.grounds);
  return r;
}

bool BagSensors::StampCheck::plausible(TimeNs stamp, TimeNs recorded) {
  const TimeNs offset = stamp - recorded;
  const bool jumped = offset_ && std::abs(offset - *offset_) > kMaxStampJump;
  if (jumped && ++jumps_ < kJumpsAccepted) return false;
  jumps_ = 0;
  offset_ = offset;
  return true;
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
  const bool of_stamps_clock = sweep->stamp - notes.stamp < kMaxStampJump;
  begin_ = (of_stamps_clock ? std::min(notes.stamp, sweep->stamp) : sweep->stamp) -
           core::from_seconds(recording_.info.period_s);
  first_.emplace(std::move(*sweep), notes);
}

bool BagSensors::read_one() {
  const auto m = bag_->next();
  if (!m) return false;
  try {
    if (bag_->connections()[m->connection].type == "sensor_msgs/Imu")
      take_imu(*m);
    else
      take_cloud(*m);
  } catch (const MalformedError& e) {
    faults_.add(place_of_message(bag_->connections()[m->connection], *m), e.what());
  }
  return true;
}

void BagSensors::take_cloud(const BagMessage& m) {
  const Connection& c = bag_->connections()[m.connection];
  CloudMessage cloud = cloud_of(c.type, decoder_.decode(m.connection, m.bytes), recording_.info.fields);
  if (!cloud_stamps_.plausible(cloud.stamp, m.time))
    throw MalformedError(
        "its stamp " + decimal_seconds(cloud.stamp) + " s jumps against the time of recording", 0);
  clouds_.push_back({std::move(cloud), place_of_message(c, m)});
}

void BagSensors::take_imu(const BagMessage& m) {
  core::ImuSample sample = imu_of(decoder_.decode(m.connection, m.bytes));
  if (!imu_stamps_.plausible(sample.stamp, m.time))
    throw MalformedError(
        "its stamp " + decimal_seconds(sample.stamp) + " s jumps against the time of recording", 0);
  if (last_imu_ && sample.stamp < *last_imu_)
    throw MalformedError("its stamp " + decimal_seconds(sample.stamp) + " s goes back in time", 0);
  last_imu_ = sample.stamp;
  constexpr double kStandardGravity = 9.80665;
  if (recording_.info.imu_force_unit == ForceUnit::g) sample.specific_force_mps2 *= kStandardGravity;
  sample.specific_force_mps2 = recording_.layout.R_body_imu * sample.specific_force_mps2;
  sample.body_rate_radps = recording_.layout.R_body_imu * sample.body_rate_radps;
  imu_.push_back(sample);
  if (imu_.size() > kMaxSamplesAhead) {
    imu_.pop_front();
    throw MalformedError("a million samples came without a scan: the oldest are left out", 0);
  }
}

std::optional<core::Sweep> BagSensors::make_sweep(ReadNotes& notes) {
  for (;;) {
    while (clouds_.empty())
      if (!read_one()) return std::nullopt;
    QueuedCloud next = std::move(clouds_.front());
    clouds_.pop_front();
    notes = {next.cloud.stamp, 0, false};
    core::Sweep sweep;
    try {
      sweep = sweep_of(std::move(next.cloud.scan), next.cloud.stamp, {recording_.path, next.place},
                       recording_.info, recording_.layout, &notes);
    } catch (const InputError& e) {
      if (!last_sweep_) throw;  // the recording file is wrong rather than one scan
      faults_.add(next.place, std::string(e.what()).substr(recording_.path.size() + next.place.size() + 4));
      continue;
    }
    if (last_sweep_ && sweep.stamp <= *last_sweep_) {
      faults_.add(next.place, "its last point is not after that of the scan before it");
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

std::size_t write_truth(const std::string& path, const std::string& topic, const std::string& tum_file) {
  const auto bag = open_bag(path);
  MessageDecoder decoder(bag->connections());
  std::vector<bool> wanted;
  for (const Connection& c : bag->connections()) wanted.push_back(c.topic == topic && is_pose_type(c.type));
  if (std::find(wanted.begin(), wanted.end(), true) == wanted.end())
    throw InputError(path, "topic " + topic,
                     "has no nav_msgs/Odometry or geometry_msgs/PoseStamped, which bag.truth asks for");
  bag->select(std::move(wanted));
  std::ofstream out(tum_file, std::ios::trunc);
  std::size_t poses = 0;
  while (const auto m = bag->next()) {
    const std::string& type = bag->connections()[m->connection].type;
    try {
      const StampedPose pose = pose_of(type, decoder.decode(m->connection, m->bytes));
      const core::Vec3& p = pose.T_world_body.position;
      const core::Quat& q = pose.T_world_body.orientation;
      if (!p.allFinite()) continue;
      std::array<char, 256> line;
      std::snprintf(line.data(), line.size(), "%s %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n",
                    decimal_seconds(pose.stamp).c_str(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
      out << line.data();
      ++poses;
    } catch (const MalformedError&) {
      continue;  // a pose less; the replay tells of damage
    }
  }
  out.flush();
  if (!out) throw InputError(tum_file, "", "cannot be written");
  return poses;
}

}  // namespace karst::replay
