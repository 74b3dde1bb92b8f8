#include "sdk/live/flight_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "core_stack/common/json_text.h"
#include "core_stack/mission/recording/recorder.h"
#include "sdk/evaluation/record/lines.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/point_cloud.h"

namespace karst::live {
namespace {

using core::Recorder;
using core::RecordPart;
using mcap::kBodyFrame;

constexpr const char *kTf = "/tf", *kOdometry = "/odometry", *kPath = "/path", *kMap = "/map",
                     *kNewCells = "/map/new", *kBattery = "/battery";

std::size_t place_of(std::string_view topic) {
  const auto& all = flight_topics();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const LiveTopic& t) { return t.name == topic; });
  return static_cast<std::size_t>(found - all.begin());
}

[[noreturn]] void refuse(const char* file, std::string_view line) {
  throw std::runtime_error(std::string(file) + ": no such line is recorded: " + std::string(line));
}

/// The part of a line between two commas.
std::string_view cell_at(std::string_view line, std::size_t index) {
  while (index-- > 0) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) return {};
    line.remove_prefix(comma + 1);
  }
  return line.substr(0, line.find(','));
}

std::size_t column_of(std::string_view header, std::string_view name) {
  std::size_t index = 0;
  while (cell_at(header, index) != name) ++index;
  return index;
}

/// Reads the numbers of some columns of a line.
template <std::size_t N>
class Columns {
 public:
  Columns(std::string_view header, const std::array<std::string_view, N>& names) {
    for (std::size_t i = 0; i < N; ++i) index_[i] = column_of(header, names[i]);
  }
  std::array<double, N> of(const char* file, std::string_view line) const {
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i)
      if (!evaluation::parse_number(std::string(cell_at(line, index_[i])), values[i])) refuse(file, line);
    return values;
  }

 private:
  std::array<std::size_t, N> index_{};
};

std::string_view without_end(std::string_view line) {
  return line.ends_with('\n') ? line.substr(0, line.size() - 1) : line;
}

/// The last of a queue by time that is not after t, as a row of a table would be looked up.
template <class Row, class Time>
const Row* row_at(const std::deque<Row>& rows, double t_s, Time Row::*time) {
  const auto after = std::upper_bound(rows.begin(), rows.end(), t_s + mcap::kTimeRounding_s,
                                      [time](double t, const Row& row) { return t < row.*time; });
  return after == rows.begin() ? nullptr : &*(after - 1);
}

/// Lines so old that no pose asks for them.
constexpr std::size_t kKeptRows = 64;
template <class Row>
void keep(std::deque<Row>& rows, Row row) {
  rows.push_back(std::move(row));
  if (rows.size() > kKeptRows) rows.pop_front();
}

}  // namespace

const std::vector<LiveTopic>& flight_topics() {
  static const std::vector<LiveTopic> topics = [] {
    std::vector<LiveTopic> all = {{kTf, ros::schema_of<ros::TFMessage>(), Keeping::none},
                                  {kOdometry, ros::schema_of<ros::Odometry>(), Keeping::none},
                                  {kPath, ros::schema_of<ros::Path>(), Keeping::whole},
                                  {kMap, ros::schema_of<ros::PointCloud2>(), Keeping::whole},
                                  {kNewCells, ros::schema_of<ros::PointCloud2>(), Keeping::since_latest_map},
                                  {kBattery, ros::schema_of<ros::BatteryState>(), Keeping::last}};
    const auto add = [&]<class Messages>(const Messages&) {
      const bool log = std::is_same_v<Messages, mcap::LogMessages>;
      const bool drawings = std::is_same_v<Messages, mcap::DrawingMessages>;
      all.push_back({Messages::kTopic, ros::schema_of<typename Messages::Message>(),
                     log || drawings ? Keeping::none : Keeping::last});
    };
    std::apply([&](const auto&... messages) { (add(messages), ...); }, mcap::EventMessages{});
    return all;
  }();
  return topics;
}

std::size_t map_topic() { return place_of(kMap); }
std::size_t new_cells_topic() { return place_of(kNewCells); }

void FlightMessages::take(RecordPart part, std::string_view bytes) {
  switch (part) {
    case RecordPart::events:
      return take_event(bytes);
    case RecordPart::trajectory:
      return take_pose(without_end(bytes));
    case RecordPart::telemetry:
      return take_telemetry(without_end(bytes));
    case RecordPart::localization:
      return take_localization(without_end(bytes));
    case RecordPart::map_growth:
      return take_growth(bytes);
  }
}

template <class M>
void FlightMessages::put(const char* topic, double t_s, const M& message) {
  sink_({place_of(topic), clock_.ns(t_s), std::make_shared<const std::string>(ros::cdr_of(message))});
}

template <class M>
void FlightMessages::put(const char* topic, std::optional<mcap::Stamped<M>> made) {
  if (made) put(topic, made->t_s, made->message);
}

void FlightMessages::take_event(std::string_view line) {
  const auto json = core::json_of<nlohmann::json>(line);
  if (!json.is_object() || !json.contains("t") || !json["t"].is_number()) refuse("events.jsonl", line);
  std::optional<core::event::Event> event = core::event::read(json);
  if (!event) return;
  const mcap::TimedEvent e{json["t"].get<double>(), std::move(*event)};
  advance(e.t_s);
  const auto add = [&](auto& messages) { put(messages.kTopic, messages.take(e, clock_)); };
  std::apply([&](auto&... messages) { (add(messages), ...); }, events_);
}

void FlightMessages::take_pose(std::string_view line) {
  const auto pose = evaluation::pose_of_line(std::string(line));
  if (!pose) refuse("trajectory.tum", line);
  if (last_ && pose->t_s < last_->t_s) return;
  advance(pose->t_s);
  put(kTf, pose->t_s, mcap::tf_of(*pose, clock_, kBodyFrame));
  tell_odometry(*pose);
  while (pose->t_s > path_times_.due_s()) {
    if (last_) tell_path(path_times_.due_s());
    path_times_.told();
  }
  path_.add(*pose, clock_);
  before_ = std::exchange(last_, pose);
}

/// Of the pose before, now that it is known what comes after it.
void FlightMessages::tell_odometry(const evaluation::StampedPose& after) {
  if (!last_) return;
  const double t_s = last_->t_s;
  const Velocity* v = row_at(velocities_, t_s, &Velocity::t_s);
  const bool known = v && std::abs(v->t_s - t_s) <= mcap::kSameTime_s && v->velocity_mps.allFinite();
  const Sigmas* s = row_at(sigmas_, t_s, &Sigmas::used_s);
  put(kOdometry, t_s,
      mcap::odometry_of({before_ ? *before_ : *last_, *last_, after}, clock_, kBodyFrame,
                        known ? std::optional(v->velocity_mps) : std::nullopt,
                        s ? std::optional(s->sigmas) : std::nullopt));
}

void FlightMessages::tell_path(double t_s) { put(kPath, t_s, path_.until(t_s, clock_)); }

void FlightMessages::take_telemetry(std::string_view line) {
  static const Columns<5> columns(Recorder::kTelemetryColumns, {"t_s", "vx", "vy", "vz", "battery_fraction"});
  const auto [t_s, vx, vy, vz, battery] = columns.of("telemetry.csv", line);
  advance(t_s);
  keep(velocities_, {t_s, core::Vec3(vx, vy, vz)});
  if (battery_.takes(t_s, battery)) put(kBattery, t_s, mcap::battery_of(t_s, battery, clock_));
}

void FlightMessages::take_localization(std::string_view line) {
  static const Columns<3> columns(Recorder::kLocalizationColumns,
                                  {"used_s", "position_sigma_m", "heading_sigma_rad"});
  const auto [used_s, position_m, heading_rad] = columns.of("localization.csv", line);
  keep(sigmas_, {used_s, {position_m, heading_rad}});
}

void FlightMessages::take_growth(std::string_view record) {
  if (record.size() != 16) refuse("map_growth.bin", "not 16 bytes");
  std::array<std::int32_t, 4> numbers;
  std::memcpy(numbers.data(), record.data(), sizeof numbers);
  const core::CellKey key{numbers[0], numbers[1], numbers[2]};
  const std::int32_t ms = numbers[3];
  advance(mcap::seconds_of_ms(std::abs(ms)));
  if (ms < 0) {
    occupied_.erase(key);
  } else if (occupied_.emplace(key, ms).second) {
    if (!new_cells_.empty() && mcap::new_cells_step(new_cells_.front().from_ms) != mcap::new_cells_step(ms))
      tell_new_cells();
    new_cells_.push_back({ms, key});
  }
}

/// What is due by a time that has come is told before anything of that time is taken.
void FlightMessages::advance(double t_s) {
  now_s_ = std::max(now_s_, t_s);
  if (!new_cells_.empty() &&
      t_s > static_cast<double>(mcap::new_cells_step(new_cells_.front().from_ms)) * mcap::kNewCellsStep_s)
    tell_new_cells();
  while (t_s > map_times_.due_s()) {
    if (!occupied_.empty()) tell_map(map_times_.due_s());
    map_times_.told();
  }
}

void FlightMessages::tell_new_cells() {
  std::sort(new_cells_.begin(), new_cells_.end(), [](const NewCell& a, const NewCell& b) {
    return a.from_ms != b.from_ms ? a.from_ms < b.from_ms : a.key < b.key;
  });
  const double t_s =
      static_cast<double>(mcap::new_cells_step(new_cells_.front().from_ms)) * mcap::kNewCellsStep_s;
  ros::PointCloud2 cloud = mcap::cells_cloud(t_s, clock_);
  for (const NewCell& c : new_cells_)
    mcap::append_cell(cloud, c.key, resolution_m_, mcap::seconds_of_ms(c.from_ms));
  put(kNewCells, t_s, ros::finished(std::move(cloud)));
  new_cells_.clear();
}

void FlightMessages::tell_map(double t_s) {
  std::vector<NewCell> cells;
  cells.reserve(occupied_.size());
  for (const auto& [key, ms] : occupied_) cells.push_back({ms, key});
  std::sort(cells.begin(), cells.end(), [](const NewCell& a, const NewCell& b) { return a.key < b.key; });
  ros::PointCloud2 cloud = mcap::cells_cloud(t_s, clock_);
  cloud.data.reserve(cells.size() * cloud.point_step);
  for (const NewCell& c : cells)
    mcap::append_cell(cloud, c.key, resolution_m_, mcap::seconds_of_ms(c.from_ms));
  put(kMap, t_s, ros::finished(std::move(cloud)));
}

void FlightMessages::end(const core::VoxelMap* stored) {
  const auto finish = [&](auto& messages) { put(messages.kTopic, mcap::end_of(messages)); };
  std::apply([&](auto&... messages) { (finish(messages), ...); }, events_);
  if (last_) {
    tell_odometry(*last_);
    tell_path(last_->t_s);
  }
  if (!new_cells_.empty()) tell_new_cells();
  if (stored)  // it has what the last scans changed while the vehicle touched down
    put(kMap, now_s_, mcap::map_cloud(*stored, now_s_, clock_, [this](const core::CellKey& key) {
          const auto found = occupied_.find(key);
          return found == occupied_.end() ? std::nan("") : mcap::seconds_of_ms(found->second);
        }));
  else if (!occupied_.empty())
    tell_map(now_s_);
}

}  // namespace karst::live
