#include "plugins/lidar_drivers/ouster/sweep_assembler.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "plugins/lidar_drivers/packet/plausible.h"
#include "plugins/lidar_drivers/packet/range_corrected.h"

namespace karst::lidar {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kOvertaking = 4;                              // packets of the next sweep that close one
constexpr core::TimeNs kSilence = 50 * core::kMillisecond;  // without a packet, after which a sweep is closed
constexpr int kMaxLostSweeps = 600, kRestart = 3;
constexpr std::int64_t kEven = 1000;  // ns: columns are evenly spaced in time if they differ by less
/// A greater difference between two columns of a sweep cannot be.
constexpr std::int64_t kMaxSweep = 2 * core::kSecond;

}  // namespace

OusterSweepAssembler::OusterSweepAssembler(const OusterMetadata& metadata,
                                           std::shared_ptr<const core::LidarModel> model)
    : metadata_(metadata), layout_(metadata), model_(std::move(model)) {}

OusterSweepAssembler::Sweep& OusterSweepAssembler::begin(std::uint16_t id) {
  if (open_.size() == 2) close_oldest();
  newest_id_ = id;
  const auto columns = static_cast<std::size_t>(model_->columns), pixels = model_->elevation_rad.size();
  Sweep s;
  s.id = id;
  s.column_ns.resize(columns);
  s.came.resize(columns);
  s.scan.model = model_;
  s.scan.range_m.assign(columns * pixels, kNan);
  s.scan.intensity.assign(columns * pixels, 0.0f);
  open_.push_back(std::move(s));
  return open_.back();
}

/// Null if the sweep was closed, or if the number is not believed.
OusterSweepAssembler::Sweep* OusterSweepAssembler::sweep_of(std::uint16_t id, core::TimeNs now) {
  for (Sweep& s : open_)
    if (s.id == id) {
      strange_ids_ = 0;
      s.last_packet = now;
      return &s;
    }
  const auto ahead = static_cast<std::int16_t>(id - newest_id_.value_or(static_cast<std::uint16_t>(id - 1)));
  // One damaged number must not close what is open; a sensor that starts anew sends more than one.
  const bool follows = ahead > 0 && ahead <= kMaxLostSweeps;
  if (!follows && ahead <= 0 && ahead > -3) {
    ++counts_.late;
    return nullptr;
  }
  if (!follows || ahead > 2) {
    strange_ids_ = strange_ids_ > 0 && strange_id_ == id ? strange_ids_ + 1 : 1;
    strange_id_ = id;
    if (strange_ids_ < kRestart) {
      ++counts_.malformed;
      return nullptr;
    }
    while (!open_.empty()) close_oldest();
  }
  strange_ids_ = 0;
  if (follows) counts_.lost_scans += static_cast<std::uint64_t>(ahead) - 1;
  Sweep& s = begin(id);
  s.last_packet = now;
  return &s;
}

std::optional<std::int64_t> OusterSweepAssembler::take(PacketView packet, core::TimeNs now) {
  if (!layout_.is_ours(packet)) {
    ++counts_.foreign;
    return std::nullopt;
  }
  for (int c = 0; c < layout_.columns(); ++c) {
    const OusterColumnHeader h = layout_.column(packet, c);
    if (h.valid && (h.measurement_id >= metadata_.columns_per_frame || h.timestamp_ns >= kEndOfTime_ns)) {
      ++counts_.malformed;
      return std::nullopt;
    }
  }
  Sweep* sweep = sweep_of(layout_.frame_id(packet), now);
  if (!sweep) return std::nullopt;
  ++sweep->packets;

  std::optional<std::int64_t> newest;
  bool fresh = false;
  const auto columns = static_cast<std::size_t>(model_->columns);
  for (int c = 0; c < layout_.columns(); ++c) {
    const OusterColumnHeader h = layout_.column(packet, c);
    if (!h.valid) continue;
    const auto stamp = static_cast<std::int64_t>(h.timestamp_ns);
    newest = std::max(newest.value_or(stamp), stamp);
    if (sweep->came[h.measurement_id] || !metadata_.in_window(h.measurement_id)) continue;
    sweep->came[h.measurement_id] = 1;
    sweep->column_ns[h.measurement_id] = stamp;
    ++sweep->columns;
    fresh = true;
    for (int p = 0; p < metadata_.pixels(); ++p) {
      const OusterPixel pixel = layout_.pixel(packet, c, p);
      const float range_m = static_cast<float>(pixel.range_mm) / 1000 - model_->beam_origin_m;
      if (pixel.range_mm == 0 || range_m < model_->min_range_m) continue;
      const std::size_t at = static_cast<std::size_t>(p) * columns + h.measurement_id;
      // Reflectivity: 0 to 100 is per cent of a diffuse surface, more are retroreflectors.
      sweep->scan.range_m[at] = range_m;
      sweep->scan.intensity[at] =
          std::min(static_cast<float>(pixel.reflectivity) / 100, 1.0f) / intensity_fall_off(range_m);
    }
  }
  ++(fresh || !newest ? counts_.packets : counts_.late);
  if (sweep->columns == metadata_.columns_in_window()) {
    // An older one that is still open has lost its end: packets do not stay behind for a whole revolution.
    while (!open_.empty() && &open_.front() != sweep) {
      close_oldest();
      sweep = &open_.front();
    }
    close_oldest();
  } else if (open_.size() == 2 && sweep == &open_.back() && sweep->packets >= kOvertaking) {
    close_oldest();
  }
  return newest;
}

void OusterSweepAssembler::close_oldest() {
  Sweep sweep = std::move(open_.front());
  open_.erase(open_.begin());
  counts_.lost += static_cast<std::uint64_t>(metadata_.columns_in_window() - sweep.columns);
  if (sweep.columns == 0) return;
  ++counts_.scans;
  closed_.push_back(finished(std::move(sweep)));
}

RawSweep OusterSweepAssembler::finished(Sweep s) const {
  const std::int64_t n = model_->columns, period = model_->period;
  std::size_t last = 0;
  for (std::size_t j = 0; j < s.came.size(); ++j)
    if (s.came[j] && (!s.came[last] || s.column_ns[j] > s.column_ns[last])) last = j;
  // If the columns are evenly spaced: column j at stamp - period + period (j + 1) / n.
  const std::int64_t newest = s.column_ns[last];
  const std::int64_t stamp = newest + period - period * (static_cast<std::int64_t>(last) + 1) / n;
  bool even = true;
  for (std::size_t j = 0; j < s.came.size(); ++j)
    if (s.came[j]) {
      const std::int64_t expected = stamp - period + period * (static_cast<std::int64_t>(j) + 1) / n;
      even = even && std::abs(s.column_ns[j] - expected) <= kEven;
    }
  RawSweep out{even ? stamp : newest, std::move(s.scan)};
  if (even) return out;

  // Columns that did not come follow evenly on the last that came; their time matters only to free space.
  out.scan.time_s.resize(s.came.size());
  std::int64_t from = newest - period * static_cast<std::int64_t>(last) / n;
  for (std::size_t j = 0; j < s.came.size(); ++j) {
    const std::int64_t expected = j == 0 ? from : from + period / n;
    from = s.came[j] ? s.column_ns[j] : expected;
    const std::int64_t before = std::clamp<std::int64_t>(newest - from, 0, kMaxSweep);
    out.scan.time_s[j] = -static_cast<float>(core::seconds(before));
  }
  return out;
}

std::vector<RawSweep> OusterSweepAssembler::closed(core::TimeNs now) {
  while (!open_.empty() && now - open_.front().last_packet > kSilence) close_oldest();
  return std::exchange(closed_, {});
}

}  // namespace karst::lidar
