// Takes pictures of every wall: full coverage, the paper's mission without blind spots for a camera with a
// limited field of view. docs/policies/surface_coverage.md
#include <karst/goal_history.h>
#include <karst/policy.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "account.h"
#include "candidates.h"
#include "tour.h"

namespace surface_coverage {
namespace {

/// A viewpoint worth flying to: for a picture of `cells`, or to look behind a frontier.
struct Stop {
  Viewpoint at;
  std::vector<Vec3> cells;
  std::uint32_t frontier_id = 0;
  double gain = 0;    // number of cells, seen or hoped for
  double time_s = 0;  // flight time from the vehicle
};

class SurfaceCoverage : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("horizon", horizon_m_, "m", 5, 500,
          "surface farther than this is looked after when none is left nearer");
    p.add("patch", patch_m_, "m", 0.3, 5, "edge of the patches of surface that are looked at together");
    p.add("patches", patches_, 4, 500, "how many patches are thought about in a decision");
    p.add("min_gain", min_gain_, 1, 1000,
          "a picture must show at least so many new cells to be worth a flight");
    p.add("frontier_worth", frontier_worth_, "", 0, 100,
          "cells of new surface hoped for, for each frontier cell");
    p.add("patience", patience_s_, "s", 1, 300,
          "time in which the worth of something still to come falls to 1/e");
    p.add("stops", stops_, 1, 8, "stops of the tour");
    p.add("tries", tries_, 1, 10, "pictures that fail to show a cell until it is given up");
  }

  karst::Decision decide(const karst::Request& request) override {
    std::unique_ptr<Account> account = host_account(request);
    if (!account) account = own_.update(request);
    count_tries(request, *account);
    std::vector<Stop> tour;
    for (const double horizon_m : {horizon_m_, 1000.0}) {
      tour = plan(request, *account, horizon_m);
      if (!tour.empty()) break;
    }
    if (tour.empty()) return nothing_left(request);
    idle_since_ns_ = -1;
    draw(request, tour);
    return karst::Decision::tour(goals_of(tour));
  }

  void on_event(const karst::Event& event) override {
    memory_.on_event(event);
    if (event.goal.frontier_id != 0) return;
    if (event.kind == KARST_EVENT_GOAL_REACHED) {
      const bool stood_there = event.reason.empty();  // else the goal was passed, at any heading
      for (const Stop& s : proposed_)
        if (stood_there && distance(s.at.position, event.goal.position) < 1e-3)
          tried_.insert(tried_.end(), s.cells.begin(), s.cells.end());
    } else if (event.kind == KARST_EVENT_GOAL_REJECTED || event.kind == KARST_EVENT_GOAL_UNREACHABLE ||
               event.kind == KARST_EVENT_GOAL_ABANDONED) {
      refused_.push_back({event.goal.position, event.stamp_ns});
    }
  }

 private:
  /// Counts a miss for each cell that the last picture was taken for and that is still not imaged.
  void count_tries(const karst::Request& request, const Account& account) {
    if (tried_.empty()) return;
    const double resolution_m = request.map.resolution_m();
    Box box{tried_.front(), tried_.front()};
    for (const Vec3& c : tried_) {
      box.low = {std::min(box.low.x, c.x), std::min(box.low.y, c.y), std::min(box.low.z, c.z)};
      box.high = {std::max(box.high.x, c.x), std::max(box.high.y, c.y), std::max(box.high.z, c.z)};
    }
    std::set<CellId> left;
    for (const SurfaceCell& c : account.unimaged(box)) left.insert(cell_id(c.center, resolution_m));
    for (const Vec3& c : tried_)
      if (const CellId id = cell_id(c, resolution_m); left.count(id)) ++misses_[id];
    tried_.clear();
  }
  bool given_up(const CellId& id) const {
    const auto found = misses_.find(id);
    return found != misses_.end() && found->second >= tries_;
  }

  double seconds_for(const karst::Request& request, double length_m, double turn_rad) const {
    // Includes acceleration and braking, and the turn to the picture's heading at the end.
    constexpr double kStop_s = 1.5, kTurn_radps = 1.0;
    return length_m / (0.6 * request.max_speed_mps) + kStop_s +
           std::abs(std::remainder(turn_rad, 2 * kPi)) * 0.5 / kTurn_radps;
  }

  std::vector<Stop> plan(const karst::Request& request, const Account& account, double horizon_m) {
    std::vector<Stop> all = pictures(request, account, horizon_m);
    for (Stop& s : frontiers(request)) all.push_back(std::move(s));
    if (all.empty()) return {};
    std::vector<Vec3> places;
    for (const Stop& s : all) places.push_back(s.at.position);
    const std::vector<double> lengths = request.path_lengths(request.position(), places, 0.5);
    const double heading = std::atan2(request.direction_of_flight.y, request.direction_of_flight.x);
    std::vector<Stop> open;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!std::isfinite(lengths[i])) continue;
      all[i].time_s = seconds_for(request, lengths[i], all[i].at.heading_rad - heading);
      open.push_back(std::move(all[i]));
    }
    return in_order(request, cover(request, std::move(open)));
  }

  std::vector<Stop> pictures(const karst::Request& request, const Account& account, double horizon_m) const {
    const double resolution_m = request.map.resolution_m();
    std::vector<SurfaceCell> cells = account.unimaged(karst::box_around(request.position(), horizon_m));
    cells.erase(
        std::remove_if(cells.begin(), cells.end(),
                       [&](const SurfaceCell& c) { return given_up(cell_id(c.center, resolution_m)); }),
        cells.end());
    std::vector<Patch> patches = patches_of(cells, patch_m_);
    const auto worth = [&](const Patch& p) {
      return static_cast<double>(p.cells) *
             std::exp(-distance(p.center, request.position()) / (0.6 * request.max_speed_mps * patience_s_));
    };
    std::stable_sort(patches.begin(), patches.end(),
                     [&](const Patch& a, const Patch& b) { return worth(a) > worth(b); });
    std::vector<Viewpoint> places;
    std::size_t asked = 0, answered = 0;
    for (const Patch& patch : patches) {
      if (answered >= static_cast<std::size_t>(patches_) ||
          ++asked > 4u * static_cast<std::size_t>(patches_) || request.should_stop())
        break;
      const auto some = places_for(request, account.camera(), patch, 4);
      answered += !some.empty();
      places.insert(places.end(), some.begin(), some.end());
    }
    places.erase(std::remove_if(places.begin(), places.end(),
                                [&](const Viewpoint& v) { return closed(v.position, request.stamp_ns); }),
                 places.end());
    add_turns(request, places);
    std::vector<Stop> stops;
    const auto looks = account.looks(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Stop s{places[i], {}};
      for (const Vec3& c : looks[i])
        if (!given_up(cell_id(c, resolution_m))) s.cells.push_back(c);
      s.gain = static_cast<double>(s.cells.size());
      if (s.cells.size() >= static_cast<std::size_t>(min_gain_)) stops.push_back(std::move(s));
    }
    return stops;
  }

  /// Adds eight headings at the vehicle's position (a turn is cheap) and, against dithering, the last stop.
  void add_turns(const karst::Request& request, std::vector<Viewpoint>& places) const {
    constexpr double kStanding_mps = 0.3;  // at a higher speed it would have to fly back
    if (karst::norm(request.state.velocity) < kStanding_mps &&
        clear_places(request, {request.position()}).front())
      for (int i = 0; i < 8; ++i)
        places.push_back({request.position(), std::remainder(i * kPi / 4, 2 * kPi)});
    if (const Stop* s = under_way(request); s && s->frontier_id == 0) places.push_back(s->at);
  }

  const Stop* under_way(const karst::Request& request) const {
    if (request.last_fate != KARST_FATE_UNDER_WAY) return nullptr;
    for (const Stop& s : proposed_)
      if (distance(s.at.position, request.last_goal) < 1e-3) return &s;
    return nullptr;
  }

  bool closed(const Vec3& place, std::int64_t now_ns) const {
    constexpr double kSamePlace_m = 0.5;
    constexpr std::int64_t kPause_ns = 8'000'000'000;
    int times = 0;
    for (const Refusal& r : refused_) {
      if (distance(r.place, place) > kSamePlace_m) continue;
      if (++times == 3 || now_ns - r.stamp_ns < kPause_ns) return true;
    }
    return false;
  }

  std::vector<Stop> frontiers(const karst::Request& request) const {
    std::vector<Stop> stops;
    for (const karst::Frontier& f : request.frontiers) {
      if (!f.reachable() || f.cells < 10 || !memory_.judge(f, request.stamp_ns).open) continue;
      const double gain = std::min(frontier_worth_ * f.cells, 300.0);
      if (gain >= min_gain_) stops.push_back({{f.viewpoint, f.viewpoint_heading_rad}, {}, f.id, gain});
    }
    return stops;
  }

  /// A greedy cover: repeatedly takes the stop that adds most cells, discounted by its flight time.
  std::vector<Stop> cover(const karst::Request& request, std::vector<Stop> all) const {
    const double resolution_m = request.map.resolution_m();
    const Stop* const now = under_way(request);
    std::set<CellId> taken;
    std::vector<Stop> chosen;
    while (chosen.size() < static_cast<std::size_t>(stops_) && !all.empty()) {
      std::size_t best = all.size();
      double most = 0;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const double keep = now && distance(all[i].at.position, now->at.position) < 0.3 ? 1.3 : 1.0;
        const double worth = keep * all[i].gain * std::exp(-all[i].time_s / patience_s_);
        if (worth > most) {
          best = i;
          most = worth;
        }
      }
      if (best == all.size()) break;
      chosen.push_back(std::move(all[best]));
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(best));
      for (const Vec3& c : chosen.back().cells) taken.insert(cell_id(c, resolution_m));
      const bool was_frontier = chosen.back().frontier_id != 0;
      if (was_frontier) continue;
      for (Stop& s : all) {
        if (s.frontier_id != 0) continue;
        s.gain = static_cast<double>(std::count_if(s.cells.begin(), s.cells.end(), [&](const Vec3& c) {
          return taken.count(cell_id(c, resolution_m)) == 0;
        }));
      }
      all.erase(std::remove_if(all.begin(), all.end(), [&](const Stop& s) { return s.gain < min_gain_; }),
                all.end());
    }
    return chosen;
  }

  std::vector<Stop> in_order(const karst::Request& request, std::vector<Stop> chosen) const {
    if (chosen.size() < 2) return chosen;
    std::vector<double> gain, first_s;
    std::vector<Vec3> places;
    for (const Stop& s : chosen) {
      gain.push_back(s.gain);
      first_s.push_back(s.time_s);
      places.push_back(s.at.position);
    }
    std::vector<std::vector<double>> between_s;
    constexpr double kNoPath_s = 1e4;
    for (const Stop& from : chosen) {
      const std::vector<double> lengths = request.path_lengths(from.at.position, places, 0.5);
      between_s.emplace_back();
      for (std::size_t j = 0; j < lengths.size(); ++j)
        between_s.back().push_back(
            std::isfinite(lengths[j])
                ? seconds_for(request, lengths[j], chosen[j].at.heading_rad - from.at.heading_rad)
                : kNoPath_s);
    }
    std::vector<Stop> tour;
    for (const std::size_t i : best_order(gain, first_s, between_s, patience_s_))
      tour.push_back(std::move(chosen[i]));
    return tour;
  }

  std::vector<karst::Goal> goals_of(const std::vector<Stop>& tour) {
    std::vector<karst::Goal> goals;
    for (const Stop& s : tour) {
      karst::Goal g;
      g.position = s.at.position;
      g.heading_rad = s.at.heading_rad;
      g.tolerance_m = s.frontier_id == 0 ? 0.3 : 0.5;
      g.frontier_id = s.frontier_id;
      g.score = s.gain;
      char why[120];
      std::snprintf(why, sizeof why,
                    s.frontier_id == 0 ? "a picture of %.0f new cells of wall, %.0f s away"
                                       : "frontier, hope for %.0f cells of wall, %.0f s away",
                    s.gain, s.time_s);
      g.why = why;
      goals.push_back(g);
    }
    proposed_.insert(proposed_.begin(), tour.begin(), tour.end());
    if (proposed_.size() > kRemembered) proposed_.resize(kRemembered);
    return goals;
  }

  void draw(const karst::Request& request, const std::vector<Stop>& tour) const {
    std::vector<karst_segment_t> path, sights;
    Vec3 from = request.position();
    for (const Stop& s : tour) {
      path.push_back({from, s.at.position});
      from = s.at.position;
      for (std::size_t i = 0; i < s.cells.size(); i += 1 + s.cells.size() / 12)
        sights.push_back({s.at.position, s.cells[i]});
    }
    request.draw_lines(path, 0xffd23f);
    request.draw_lines(sights, 0x8fd3ff);
  }

  karst::Decision nothing_left(const karst::Request& request) {
    constexpr double kWait_s = 3;  // until the map no longer changes
    if (idle_since_ns_ < 0) idle_since_ns_ = request.stamp_ns;
    if (static_cast<double>(request.stamp_ns - idle_since_ns_) * 1e-9 < kWait_s)
      return karst::Decision::hold("no picture is left to take: waiting for the map to settle");
    char text[120];
    std::snprintf(text, sizeof text, "every wall that can be seen is in a picture; %zu cells were given up",
                  static_cast<std::size_t>(std::count_if(misses_.begin(), misses_.end(),
                                                         [&](const auto& v) { return v.second >= tries_; })));
    return karst::Decision::explored(text);
  }

  double horizon_m_ = 20, patch_m_ = 1.2, frontier_worth_ = 2, patience_s_ = 12;
  int patches_ = 60, min_gain_ = 12, stops_ = 6, tries_ = 3;
  OwnMemory own_;
  karst::GoalHistory memory_;
  static constexpr std::size_t kRemembered = 32;
  std::vector<Stop> proposed_;  // by the last decisions, newest first
  std::vector<Vec3> tried_;     // cells that the picture just taken was meant to show
  struct Refusal {
    Vec3 place;
    std::int64_t stamp_ns;
  };
  std::vector<Refusal> refused_;
  std::map<CellId, int> misses_;  // for each cell, the pictures meant to show it that did not
  std::int64_t idle_since_ns_ = -1;
};

}  // namespace
}  // namespace surface_coverage

using surface_coverage::SurfaceCoverage;
KARST_POLICY(SurfaceCoverage, "surface_coverage", "1.0.0",
             "Takes pictures of every wall: a tour over viewpoints of surface the camera has yet to see.")
