#include "sdk/evaluation/report/report_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core_stack/common/error.h"
#include "core_stack/common/rounded.h"
#include "core_stack/loops/loop_closing.h"
#include "core_stack/mapping/region/region_keys.h"
#include "sdk/evaluation/page/base64.h"
#include "sdk/evaluation/report/cloud.h"

namespace karst::evaluation {
namespace {

using core::Vec3;
using nlohmann::json;
using nlohmann::ordered_json;
namespace event = core::event;

constexpr std::size_t kMaxCloudPoints = 300000;
constexpr std::size_t kMaxMarks = 60000;  // points of one kind of mark, over all times

ordered_json rounded(const Vec3& p) {
  return {core::to_hundredths(p.x()), core::to_hundredths(p.y()), core::to_hundredths(p.z())};
}

/// Unknown points are left out.
ordered_json rounded(const std::vector<Vec3>& points) {
  ordered_json all = ordered_json::array();
  for (const Vec3& p : points)
    if (p.allFinite()) all.push_back(rounded(p));
  return all;
}

struct Heights {
  double low_m = 0, high_m = 0;
};

/// Of the map, and of the flown path.
Heights heights_of(const RunRecord& run) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Heights h{kInfinity, -kInfinity};
  const auto add = [&h](double z_m) { h = {std::min(h.low_m, z_m), std::max(h.high_m, z_m)}; };
  for (const OccupiedSpan& s : run.growth) {
    add(s.key.z * run.map_resolution_m());
    add((s.key.z + 1) * run.map_resolution_m());
  }
  for (const StampedPose& p : run.estimate) add(p.T_world_body.position.z());
  return h.low_m <= h.high_m ? h : Heights{};
}

/// A body above or below the whole map keeps its closed end.
ordered_json body_of(const core::Prism& prism, const char* keep, const Heights& map) {
  const bool closed_below = std::isfinite(prism.low_m), closed_above = std::isfinite(prism.high_m);
  const double low_m = closed_below ? prism.low_m : std::min(map.low_m, prism.high_m);
  const double high_m = closed_above ? prism.high_m : std::max(map.high_m, prism.low_m);
  ordered_json outline = ordered_json::array();
  for (const Eigen::Vector2d& p : prism.outline)
    outline.push_back({core::to_hundredths(p.x()), core::to_hundredths(p.y())});
  return {{"keep", keep},
          {"outline", std::move(outline)},
          {"low", core::to_hundredths(low_m)},
          {"high", core::to_hundredths(high_m)}};
}

struct Moment {
  double t_s;
  ordered_json content;
  std::size_t marks;
};

/// [[t, content], ...]; if there are too many marks, only every second, third ... time.
ordered_json thinned(std::vector<Moment> moments, const char* what, std::vector<std::string>& problems) {
  std::size_t total = 0;
  for (const Moment& m : moments) total += m.marks;
  const std::size_t stride = total / kMaxMarks + 1;
  if (stride > 1)
    problems.push_back("report: of the " + std::string(what) + ", one moment in " + std::to_string(stride) +
                       " is shown, to keep the page small");
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < moments.size(); i += stride)
    list.push_back({moments[i].t_s, std::move(moments[i].content)});
  return list;
}

}  // namespace

CloudArrays cloud_arrays(const RunRecord& run, std::size_t max_points, double min_cell_m, double tick_ms,
                         std::vector<std::string>& problems) {
  const auto& poses = run.estimate.empty() ? run.truth : run.estimate;
  const Cloud cloud = make_cloud(run.growth, run.map_resolution_m(), max_points, poses, min_cell_m);
  CloudArrays arrays;
  arrays.cell_m = cloud.cell_m;
  arrays.tick_s = 1e-3 * tick_ms;
  if (cloud.points.empty()) return arrays;

  const core::CellKey base = cloud.points[cloud.points.size() / 2].key;
  const auto centre = [&](std::int32_t k) { return (k + 0.5) * cloud.cell_m; };
  arrays.origin = {centre(base.x), centre(base.y), centre(base.z)};
  const auto tick = [&](std::int32_t t_ms) {
    return static_cast<std::uint16_t>(std::clamp(std::lround(t_ms / tick_ms), 0l, 65534l));
  };
  std::size_t far = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const OccupiedSpan& p = cloud.points[i];
    const std::int64_t offset[3] = {std::int64_t{p.key.x} - base.x, std::int64_t{p.key.y} - base.y,
                                    std::int64_t{p.key.z} - base.z};
    if (std::any_of(offset, offset + 3, [](std::int64_t d) { return std::abs(d) > 32767; })) {
      ++far;
      continue;
    }
    for (const std::int64_t d : offset) arrays.cells.push_back(static_cast<std::int16_t>(d));
    arrays.from.push_back(tick(p.from_ms));
    arrays.until.push_back(p.until_ms == OccupiedSpan::kNever ? 65535 : tick(p.until_ms));
    arrays.normals.insert(arrays.normals.end(), cloud.normals[i].begin(), cloud.normals[i].end());
  }
  if (far > 0)
    problems.push_back("map_growth.bin: " + std::to_string(far) + " cells lie kilometres away; left out");
  return arrays;
}

ordered_json scene_cloud(const RunRecord& run, double duration_s, std::vector<std::string>& problems) {
  const double tick_ms = std::max(1.0, duration_s * 1000) / 65534.0;
  const CloudArrays cloud = cloud_arrays(run, kMaxCloudPoints, 0, tick_ms, problems);
  if (cloud.cells.empty()) return nullptr;
  if (cloud.cell_m > run.map_resolution_m())
    problems.push_back("report: the map is drawn with cells of " + std::to_string(cloud.cell_m).substr(0, 4) +
                       " m, to keep the page small");
  return {{"count", cloud.from.size()},      {"cell_m", cloud.cell_m},
          {"origin", cloud.origin},          {"tick_s", cloud.tick_s},
          {"cells", base64_of(cloud.cells)}, {"from", base64_of(cloud.from)},
          {"until", base64_of(cloud.until)}, {"normals", base64_of(cloud.normals)}};
}

ordered_json scene_track(const std::vector<StampedPose>& poses, std::size_t max_poses) {
  if (poses.empty()) return nullptr;
  const std::size_t stride = poses.size() / max_poses + 1;
  std::vector<float> t, xyz, heading;
  const auto add = [&](const StampedPose& p) {
    t.push_back(static_cast<float>(p.t_s));
    for (int a = 0; a < 3; ++a) xyz.push_back(static_cast<float>(p.T_world_body.position[a]));
    heading.push_back(static_cast<float>(core::heading_of(p.T_world_body.orientation)));
  };
  for (std::size_t i = 0; i < poses.size(); i += stride) add(poses[i]);
  if ((poses.size() - 1) % stride != 0) add(poses.back());
  return {{"count", t.size()}, {"t", base64_of(t)}, {"xyz", base64_of(xyz)}, {"heading", base64_of(heading)}};
}

ordered_json scene_frontiers(const RunRecord& run, std::vector<std::string>& problems) {
  std::vector<Moment> moments;
  for (const json& e : run.events) {
    const auto frontiers = event::as<event::Frontiers>(e);
    if (!frontiers) continue;
    ordered_json clusters = ordered_json::array();
    for (const event::Cluster& c : frontiers->clusters) {
      if (!c.centroid.allFinite()) continue;
      clusters.push_back(rounded(c.centroid));
      clusters.back().push_back(c.unknown_cells);
      clusters.back().push_back(c.id);
    }
    const std::size_t count = clusters.size();
    moments.push_back({e["t"], std::move(clusters), count});
  }
  return thinned(std::move(moments), "frontiers", problems);
}

ordered_json scene_plans(const RunRecord& run, std::vector<std::string>& problems) {
  std::vector<Moment> moments;
  for (const json& e : run.events) {
    const auto plan = event::as<event::Plan>(e);
    if (!plan) continue;
    ordered_json points = rounded(plan->points);
    const std::size_t count = points.size();
    moments.push_back({e["t"], std::move(points), count});
  }
  return thinned(std::move(moments), "plans", problems);
}

ordered_json scene_region(const RunRecord& run, std::vector<std::string>& problems) {
  core::RegionKeys keys{run.setting("region.keep_in"), run.setting("region.keep_out")};
  if (keys.empty()) return nullptr;
  try {
    const core::FlightRegion::Limits limits = core::region_of("mission.info", keys)->limits();
    const Heights heights = heights_of(run);
    ordered_json bodies = ordered_json::array();
    if (limits.keep_in) bodies.push_back(body_of(*limits.keep_in, "in", heights));
    for (const core::Prism& p : limits.keep_out) bodies.push_back(body_of(p, "out", heights));
    return bodies;
  } catch (const core::InputError& e) {
    problems.emplace_back(e.what());
    return nullptr;
  }
}

ordered_json scene_loops(const RunRecord& run) {
  const auto state = run.loops.text.find("state");
  if (run.loops.rows == 0 || state == run.loops.text.end()) return nullptr;
  const auto place = [&](const char* visit, std::size_t row) {
    core::Vec3 p = core::Vec3::Constant(std::nan(""));
    for (int axis = 0; axis < 3; ++axis)
      if (const auto* column = run.loops.column(std::string(visit) + '_' + "xyz"[axis]))
        p[axis] = (*column)[row];
    return p;
  };
  ordered_json all = ordered_json::array();
  for (std::size_t row = 0; row < run.loops.rows; ++row) {
    const core::Vec3 older = place("older", row), newer = place("newer", row);
    if (!older.allFinite() || !newer.allFinite()) continue;
    all.push_back(
        {rounded(older), rounded(newer), state->second[row] == core::name_of(core::ClosureState::closed)});
  }
  return all;
}

ordered_json scene_objects(const RunRecord& run) {
  std::map<std::uint32_t, ordered_json> found;  // by number
  ordered_json moments = ordered_json::array();
  for (const json& e : run.events) {
    const auto o = event::as<event::Object>(e);
    if (!o || o->state == core::ObjectState::reported) continue;
    if (o->state == core::ObjectState::withdrawn || !o->position || !o->position->allFinite()) {
      found.erase(o->number);
    } else {
      found[o->number] = rounded(*o->position);
      found[o->number].push_back(o->what ? core::name_of(*o->what) : "");
    }
    ordered_json all = ordered_json::array();
    for (const auto& [n, object] : found) all.push_back(object);
    moments.push_back({e["t"], all});
  }
  return moments;
}

ordered_json scene_drawings(const RunRecord& run, std::vector<std::string>& problems) {
  std::vector<Moment> moments;
  for (const json& e : run.events) {
    // A decision without drawings clears those of the one before.
    const auto drawing = event::as<event::Drawing>(e);
    if (!drawing && !event::is_kind(e, event::Decision::kKind)) continue;
    if (moments.empty() || moments.back().t_s != e["t"].get<double>())
      moments.push_back({e["t"], ordered_json::array(), 0});
    if (!drawing) continue;
    ordered_json points = rounded(drawing->points);
    moments.back().marks += points.size();
    moments.back().content.push_back({{"shape", core::name_of(drawing->shape)},
                                      {"rgb", std::min(drawing->rgb, 0xffffffu)},
                                      {"text", drawing->text},
                                      {"points", std::move(points)}});
  }
  return thinned(std::move(moments), "policy's drawings", problems);
}

}  // namespace karst::evaluation
