#include "sdk/survey_export/flown_survey.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core_stack/common/error.h"
#include "sdk/survey/facing.h"
#include "sdk/survey_export/median.h"
#include "sdk/survey_export/middle_line.h"
#include "sdk/survey_export/wall_distance.h"

namespace karst::survey_export {
namespace {

using core::Vec3;
using survey::Leg;
using survey::Station;

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr double kPlumb_m = 0.001;          // level part of a leg that goes straight up or down
constexpr double kFrontierWithin_m = 15.0;  // of the station that is told of it
constexpr std::int32_t kFrontierCells = 2;  // around a cluster's centre that are looked at

/// Whether free cells still meet unknown ones there.
bool is_frontier(const core::VoxelMap& map, const Vec3& p) {
  bool free = false, unknown = false;
  const core::CellKey own = map.key_of(p);
  for (std::int32_t z = -kFrontierCells; z <= kFrontierCells; ++z)
    for (std::int32_t y = -kFrontierCells; y <= kFrontierCells; ++y)
      for (std::int32_t x = -kFrontierCells; x <= kFrontierCells; ++x) {
        const core::Cell c = map.at(own + core::CellKey{x, y, z});
        free = free || c == core::Cell::free;
        unknown = unknown || c == core::Cell::unknown;
      }
  return free && unknown;
}

/// At least half of the way: the vehicle sees ahead, as a surveyor does who shoots the last leg.
bool was_flown(std::span<const LinePoint> passed) {
  double flown_m = 0, length_m = 0;
  for (std::size_t i = 1; i < passed.size(); ++i) {
    const double step_m = (passed[i].position - passed[i - 1].position).norm();
    length_m += step_m;
    if (passed[i].flown && passed[i - 1].flown) flown_m += step_m;
  }
  return 2 * flown_m >= length_m;
}

class Builder {
 public:
  Builder(const FlownInput& input, const StationOptions& options) : input_(input), options_(options) {
    out_.name = input.name;
    out_.accuracy = input.accuracy;
    out_.start = input.flown.front();
    out_.survey.title = input.title;
    out_.survey.files = {input.source};
  }

  FlownSurvey built() {
    lines_ = middle_lines(*input_.map, out_.start, input_.flown);
    if (lines_.lines.empty())
      throw core::InputError(input_.source, "",
                             "the map holds no passage around the place where the flight began");
    station_of_.assign(lines_.nodes.size(), kNone);
    add_node(0);
    for (const MiddleLine& line : lines_.lines) add_line(line);
    measure_sections();
    mark_continuations();
    return std::move(out_);
  }

 private:
  const Station& station(std::uint32_t i) const { return out_.survey.stations[i]; }

  std::uint32_t add_station(const Vec3& position) {
    Station s;
    s.name = input_.name + "." + std::to_string(out_.survey.stations.size() + 1);
    s.position_m = position;
    out_.survey.stations.push_back(std::move(s));
    return static_cast<std::uint32_t>(out_.survey.stations.size() - 1);
  }

  std::uint32_t add_node(std::uint32_t node) {
    if (station_of_[node] != kNone) return station_of_[node];
    const std::uint32_t i = station_of_[node] = add_station(lines_.nodes[node].point.position);
    Station& s = out_.survey.stations[i];
    if (node == 0) {
      s.entrance = s.fixed = true;
      s.comment = "start of the flight";
    } else if (lines_.nodes[node].kind == LineNode::Kind::open_end) {
      s.continuation = true;
    }
    return i;
  }

  void add_leg(std::uint32_t from, std::uint32_t to, bool approximate, std::uint32_t run) {
    const Vec3 v = station(to).position_m - station(from).position_m;
    Leg leg;
    leg.from = from;
    leg.to = to;
    leg.approximate = approximate;
    leg.length_m = v.norm();
    const double level_m = std::hypot(v.x(), v.y());
    if (level_m > kPlumb_m) {
      const double bearing = std::atan2(v.x(), v.y());
      leg.bearing_rad = bearing < 0 ? bearing + 2 * std::numbers::pi : bearing;
    }
    leg.inclination_rad =
        level_m > kPlumb_m ? std::atan2(v.z(), level_m) : std::copysign(0.5 * std::numbers::pi, v.z());
    leg.run = run;
    out_.survey.legs.push_back(leg);
    out_.leg_sd_m.push_back(input_.accuracy.leg_sd_m(v.norm()));
  }

  void add_line(const MiddleLine& line) {
    out_.blocked_legs += line.blocked;
    const std::vector<std::size_t> chosen = stations_on(*input_.map, line, options_);
    const auto run = static_cast<std::uint32_t>(run_++);
    std::uint32_t before = add_node(line.nodes[0]);
    add_section(before, static_cast<std::uint32_t>(out_.survey.legs.size()), run);
    for (std::size_t i = 1; i < chosen.size(); ++i) {
      const std::span<const LinePoint> passed(&line.points[chosen[i - 1]], chosen[i] - chosen[i - 1] + 1);
      const std::uint32_t here =
          i + 1 == chosen.size() ? add_node(line.nodes[1]) : add_station(passed.back().position);
      add_leg(before, here, !was_flown(passed), run);
      add_section(here, static_cast<std::uint32_t>(out_.survey.legs.size() - 1), run);
      before = here;
    }
  }

  void add_section(std::uint32_t at, std::uint32_t leg, std::uint32_t run) {
    survey::Section s;
    s.station = at;
    s.leg = leg;
    s.run = run;
    out_.survey.sections.push_back(s);
  }

  void measure_sections() {
    survey::set_facings(out_.survey);
    for (survey::Section& s : out_.survey.sections) s.dimensions = usual_dimensions(s);
  }

  /// The median of the distances at the station and along the legs before and behind: a niche, or a bend that
  /// a ray looks along, is no width of the passage. None where half of the places or more have none.
  survey::Dimensions usual_dimensions(const survey::Section& s) const {
    constexpr double kAround_m = 1.0, kApart_m = 0.25;
    constexpr double kSteep = 0.5;  // level part of a leg's direction below which it is a shaft: 60 degrees
    const Vec3& at = station(s.station).position_m;
    std::vector<survey::Dimensions> measured;
    const auto measure = [&](const Vec3& p, const Vec3& facing) {
      if (input_.map->at(p) != core::Cell::free) return;
      measured.push_back(
          across_passage(*input_.map, out_.survey, p, facing, dimensions_at(*input_.map, p, facing)));
    };
    measure(at, s.facing);
    for (const Leg& leg : out_.survey.legs) {
      if (leg.run != s.run || (leg.from != s.station && leg.to != s.station)) continue;
      const Vec3 v = station(leg.to).position_m - station(leg.from).position_m;
      const Vec3 level(v.x(), v.y(), 0);
      if (level.norm() < kSteep * v.norm()) continue;  // up and down would be measured along it
      const Vec3 facing = level.normalized(), away = (leg.from == s.station ? v : -v).normalized();
      for (double m = kApart_m; m <= std::min(kAround_m, 0.5 * v.norm()); m += kApart_m)
        measure(at + m * away, facing);
    }
    survey::Dimensions usual;
    for (const auto distance : {&survey::Dimensions::left_m, &survey::Dimensions::right_m,
                                &survey::Dimensions::up_m, &survey::Dimensions::down_m}) {
      std::vector<double> known;
      for (const survey::Dimensions& d : measured)
        if (d.*distance) known.push_back(*(d.*distance));
      if (2 * known.size() > measured.size()) usual.*distance = median(std::move(known));
    }
    return usual;
  }

  void mark_continuations() {
    for (const Vec3& p : input_.frontiers) {
      if (!is_frontier(*input_.map, p)) continue;
      Station* nearest = nullptr;
      double least = kFrontierWithin_m;
      for (Station& s : out_.survey.stations)
        if (const double away = (s.position_m - p).norm(); away < least) {
          least = away;
          nearest = &s;
        }
      if (nearest != nullptr) nearest->continuation = true;
    }
    for (Station& s : out_.survey.stations)
      if (s.continuation && s.comment.empty()) s.comment = "goes on into unknown space";
  }

  const FlownInput& input_;
  const StationOptions& options_;
  MiddleLines lines_;
  std::vector<std::uint32_t> station_of_;  // each node
  std::size_t run_ = 0;
  FlownSurvey out_;
};

}  // namespace

FlownSurvey flown_survey(const FlownInput& input, const StationOptions& options) {
  if (input.flown.empty()) throw core::InputError(input.source, "", "nothing was flown");
  return Builder(input, options).built();
}

std::string survey_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    name += letter ? c : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : '_';
  }
  if (name.starts_with('-')) name[0] = '_';  // no keyword of Therion begins with it
  return name.empty() ? "cave" : name;
}

}  // namespace karst::survey_export
