#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/mcap_export/flight_messages.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/point_cloud.h"

namespace karst::mcap {
namespace {

using evaluation::OccupiedSpan;
using evaluation::RunRecord;

/// When a cell of the final map became occupied for good; NaN if the growth does not tell.
double since_s(const RunRecord& run, const core::CellKey& key) {
  const auto after =
      std::upper_bound(run.growth.begin(), run.growth.end(), key,
                       [](const core::CellKey& k, const OccupiedSpan& s) { return k < s.key; });
  if (after == run.growth.begin() || (after - 1)->key != key) return std::nan("");
  return seconds_of_ms((after - 1)->from_ms);
}

using StoredMap = std::shared_ptr<const core::VoxelMap>;

/// Null without one, and for one that cannot be read, which is reported.
StoredMap stored_map(const RunRecord& run, std::vector<std::string>& problems) {
  const std::filesystem::path file = run.directory / "map.bt";
  if (!std::filesystem::exists(file)) return nullptr;
  try {
    return std::make_shared<const core::VoxelMap>(core::read_octomap(file.string()));
  } catch (const core::InputError& e) {
    problems.push_back(e.what());
    return nullptr;
  }
}

ros::PointCloud2 grown_until(const RunRecord& run, const FlightClock& clock, double t_s) {
  ros::PointCloud2 cloud = cells_cloud(t_s, clock);
  for (const OccupiedSpan& s : run.growth)
    if (seconds_of_ms(s.from_ms) <= t_s && seconds_of_ms(s.until_ms) > t_s)
      append_cell(cloud, s.key, run.map_resolution_m(), seconds_of_ms(s.from_ms));
  return ros::finished(std::move(cloud));
}

/// Whole maps, the last as it was stored. Without the growth, that one alone.
Topic whole_maps(const RunRecord& run, const FlightClock& clock, const StoredMap& stored) {
  const double end_s = run.last_time_s();
  std::vector<double> times;
  if (!run.growth.empty())
    times = snapshot_times(end_s);
  else if (stored)
    times = {end_s};
  return topic_of<ros::PointCloud2>("/map", clock, times.size(), [&run, clock, times, stored](std::size_t i) {
    const bool last = i + 1 == times.size();
    return std::pair(times[i], last && stored
                                   ? map_cloud(*stored, times[i], clock,
                                               [&](const core::CellKey& key) { return since_s(run, key); })
                                   : grown_until(run, clock, times[i]));
  });
}

/// Cells that became occupied within each step, told at its end.
Topic new_cells(const RunRecord& run, const FlightClock& clock) {
  auto spans = std::make_shared<std::vector<const OccupiedSpan*>>();
  for (const OccupiedSpan& s : run.growth) spans->push_back(&s);
  std::stable_sort(spans->begin(), spans->end(),
                   [](const auto* a, const auto* b) { return a->from_ms < b->from_ms; });
  const auto step_of = [](const OccupiedSpan* s) { return new_cells_step(s->from_ms); };
  std::vector<std::size_t> begins;  // of the steps, in the spans
  for (std::size_t i = 0; i < spans->size(); ++i)
    if (i == 0 || step_of((*spans)[i]) != step_of((*spans)[i - 1])) begins.push_back(i);
  const std::size_t steps = begins.size();
  begins.push_back(spans->size());
  return topic_of<ros::PointCloud2>(
      "/map/new", clock, steps, [&run, clock, spans, begins, step_of](std::size_t i) {
        const double t_s = static_cast<double>(step_of((*spans)[begins[i]])) * kNewCellsStep_s;
        ros::PointCloud2 cloud = cells_cloud(t_s, clock);
        for (std::size_t k = begins[i]; k < begins[i + 1]; ++k)
          append_cell(cloud, (*spans)[k]->key, run.map_resolution_m(), seconds_of_ms((*spans)[k]->from_ms));
        return std::pair(t_s, ros::finished(std::move(cloud)));
      });
}

}  // namespace

std::vector<Topic> map_topics(const RunRecord& run, const FlightClock& clock,
                              std::vector<std::string>& problems) {
  std::vector<Topic> topics;
  topics.push_back(whole_maps(run, clock, stored_map(run, problems)));
  topics.push_back(new_cells(run, clock));
  return topics;
}

}  // namespace karst::mcap
