#include "sdk/evaluation/team/team_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::evaluation {
namespace {

/// Number of cells of a growth that are occupied at a time; query times must increase.
class CellCount {
 public:
  explicit CellCount(const std::vector<OccupiedSpan>& growth) {
    for (const OccupiedSpan& s : growth) {
      changes_.push_back({s.from_ms, 1});
      if (s.until_ms != OccupiedSpan::kNever) changes_.push_back({s.until_ms, -1});
    }
    std::sort(changes_.begin(), changes_.end());
  }
  double at(double t_s) {
    for (; next_ < changes_.size() && changes_[next_].first <= 1000 * t_s; ++next_)
      cells_ += changes_[next_].second;
    return static_cast<double>(cells_);
  }

 private:
  std::vector<std::pair<std::int32_t, int>> changes_;
  std::size_t next_ = 0;
  long cells_ = 0;
};

/// The last finite value no later than a time; 0 before the first.
class Latest {
 public:
  explicit Latest(const Table& table) : t_s_(table.times()), values_(table.column("explored_m3")) {}
  double at(double t_s) {
    if (!t_s_ || !values_) return 0;
    for (; next_ < t_s_->size() && (*t_s_)[next_] <= t_s; ++next_)
      if (std::isfinite((*values_)[next_])) last_ = (*values_)[next_];
    return last_;
  }

 private:
  const std::vector<double>*t_s_, *values_;
  std::size_t next_ = 0;
  double last_ = 0;
};

}  // namespace

VolumeCurve team_volume_curve(const std::vector<RunRecord>& robots, const std::vector<OccupiedSpan>& united,
                              std::optional<double> final_m3) {
  double begin_s = std::numeric_limits<double>::infinity(), end_s = -begin_s;
  std::vector<CellCount> cells;
  std::vector<Latest> volumes;
  for (const RunRecord& r : robots) {
    cells.emplace_back(r.growth);
    volumes.emplace_back(r.telemetry);
    const auto* t_s = r.telemetry.times();
    if (!t_s || t_s->empty() || !r.telemetry.column("explored_m3")) continue;
    begin_s = std::min(begin_s, t_s->front());
    end_s = std::max(end_s, t_s->back());
  }
  VolumeCurve curve;
  std::vector<double> overlap_m3, greatest_m3;
  CellCount all(united);
  end_s = std::min(end_s, begin_s + kLongestRun_s);  // a damaged time must not make the curve endless
  for (double t = std::ceil(begin_s); t < end_s + 1 && std::isfinite(t); ++t) {
    double own_cells = 0, sum_m3 = 0, max_m3 = 0;
    for (CellCount& c : cells) own_cells += c.at(t);
    for (Latest& v : volumes) {
      const double m3 = v.at(t);
      sum_m3 += m3;
      max_m3 = std::max(max_m3, m3);
    }
    curve.t_s.push_back(t);
    curve.explored_m3.push_back(sum_m3);
    overlap_m3.push_back(own_cells > 0 ? sum_m3 * (1 - all.at(t) / own_cells) : 0);
    greatest_m3.push_back(max_m3);
  }
  if (curve.t_s.empty()) return curve;
  const double found_m3 = overlap_m3.back();
  const double scale = final_m3 && found_m3 > 0 ? (curve.explored_m3.back() - *final_m3) / found_m3 : 1;
  for (std::size_t i = 0; i < overlap_m3.size(); ++i)
    curve.explored_m3[i] = std::max(greatest_m3[i], curve.explored_m3[i] - scale * overlap_m3[i]);
  // The curve must not decrease: if the overlap is underestimated, as when a robot has just started and has
  // few rock cells, the later value is an upper bound of the earlier one.
  for (std::size_t i = curve.explored_m3.size() - 1; i > 0; --i)
    curve.explored_m3[i - 1] = std::min(curve.explored_m3[i - 1], curve.explored_m3[i]);
  return curve;
}

}  // namespace karst::evaluation
