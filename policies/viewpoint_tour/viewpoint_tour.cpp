// A tour over viewpoints of all frontiers, replanned with each decision: large information gains come early.
#include <karst/expected_gain.h>
#include <karst/open_frontiers.h>
#include <karst/straight_path.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "path_lengths.h"
#include "tour.h"

namespace {

class ViewpointTour : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    open_.parameters(p);
    gain_.parameters(p);
    p.add("max_volume", max_volume_m3_, "m^3", 0.1, 10000, "more expected volume counts as this");
    p.add("min_volume", min_volume_m3_, "m^3", 0, 100, "less expected volume counts as this");
    p.add("stop_time", stop_s_, "s", 0.1, 60, "what a stop takes besides the flight to it");
    p.add("turn_time", turn_s_, "s", 0, 60, "what flying straight back costs; less for smaller turns");
    p.add("cruise", cruise_, "", 0.1, 1, "mean speed of a flight, as a share of the greatest");
    p.add("passing", passing_m_, "m", 0, 20, "a stop this near to a straight way to the next is left out");
    p.add("keep", keep_, "", 0, 10,
          "share by which a tour must be better than one that keeps the goal under way");
    p.add("stops", stops_, 1, 200,
          "stops planned at most; those with the most volume for the time come first");
    p.add("goals", goals_, 1, 32, "how much of the tour to propose");
  }

  karst::Decision decide(const karst::Request& request) override {
    const std::vector<karst::OpenFrontiers::Candidate> open = open_.of(request);
    if (open.empty()) return open_.none_left(request);
    open_.found_some();
    const std::vector<Stop> stops = stops_of(request, open);
    const tour::Problem problem = problem_of(request, stops);
    const tour::Order order = without_passed(request, stops, tour_over(request, stops, problem));
    return karst::Decision::tour(goals(request, stops, problem, order));
  }

  void on_event(const karst::Event& event) override { open_.on_event(event); }

 private:
  struct Stop {
    const karst::Frontier* frontier;
    double weight_m3, first_s, path_m;
  };

  /// Drops first stops that a straight flight to the next stop passes: they are seen in passing.
  tour::Order without_passed(const karst::Request& request, const std::vector<Stop>& stops,
                             tour::Order order) const {
    const auto passed = [&](const Stop& stop, const Stop& next) {
      return karst::StraightPath(request.position(), next.frontier->viewpoint, next.path_m)
          .passes(stop.frontier->viewpoint, passing_m_);
    };
    if (!karst::sees_all_around(request)) return order;
    while (order.size() > 1 && passed(stops[order[0]], stops[order[1]])) order.erase(order.begin());
    return order;
  }

  double flight_s(const karst::Request& request, double length_m) const {
    return stop_s_ + length_m / (cruise_ * request.max_speed_mps);
  }

  /// One stop for all frontiers that are seen from one viewpoint, the most gain per time first.
  std::vector<Stop> stops_of(const karst::Request& request,
                             const std::vector<karst::OpenFrontiers::Candidate>& open) {
    std::vector<const karst::Frontier*> all;
    for (const auto& c : open) all.push_back(c.frontier);
    const std::vector<double> volumes_m3 = gain_.volumes_m3(request, all);
    std::vector<Stop> stops;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const double path_m = all[i]->path_length_m + open[i].revisit_penalty_m;
      const double turn_s = turn_s_ * karst::turn_fraction(request, *all[i]);
      stops.push_back({all[i], std::clamp(volumes_m3[i], min_volume_m3_, max_volume_m3_),
                       flight_s(request, path_m) + turn_s, path_m});
    }
    // The goal under way represents its site: the plan must not change when a stop's frontier id does.
    std::sort(stops.begin(), stops.end(), [&](const Stop& a, const Stop& b) {
      const bool kept_a = karst::under_way(request, *a.frontier),
                 kept_b = karst::under_way(request, *b.frontier);
      const double rate_a = a.weight_m3 / a.first_s, rate_b = b.weight_m3 / b.first_s;
      return kept_a != kept_b ? kept_a : rate_a != rate_b ? rate_a > rate_b : a.frontier->id < b.frontier->id;
    });
    std::vector<Stop> chosen;
    for (const Stop& s : stops) {
      const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const Stop& c) {
        return karst::distance(c.frontier->viewpoint, s.frontier->viewpoint) < PathLengths::same_site_m &&
               alike(c.frontier->viewpoint_heading_rad, s.frontier->viewpoint_heading_rad);
      });
      if (near) continue;
      chosen.push_back(s);
      if (chosen.size() == static_cast<std::size_t>(stops_)) break;
    }
    return chosen;
  }

  static bool alike(double a_rad, double b_rad) { return std::cos(a_rad - b_rad) > 0.7; }

  tour::Problem problem_of(const karst::Request& request, const std::vector<Stop>& stops) {
    tour::Problem p;
    std::vector<karst::Vec3> places;
    std::vector<double> from_here_m;
    for (const Stop& s : stops) {
      p.weight.push_back(s.weight_m3);
      p.first_s.push_back(s.first_s);
      places.push_back(s.frontier->viewpoint);
      from_here_m.push_back(s.path_m);
    }
    p.leg_s = paths_.between(request, places, from_here_m);
    for (std::vector<double>& row : p.leg_s)
      for (double& leg : row) leg = flight_s(request, leg);
    return p;
  }

  tour::Order tour_over(const karst::Request& request, const std::vector<Stop>& stops,
                        const tour::Problem& problem) const {
    tour::Order best = tour::min_latency(problem);
    if (!karst::under_way(request, *stops[0].frontier) || best.front() == 0) return best;
    const tour::Order kept = tour::beginning_with(problem, 0);
    return tour::latency(problem, kept) <= (1 + keep_) * tour::latency(problem, best) ? kept : best;
  }

  std::vector<karst::Goal> goals(const karst::Request& request, const std::vector<Stop>& stops,
                                 const tour::Problem& problem, const tour::Order& order) const {
    std::vector<karst::Goal> out;
    std::vector<karst_segment_t> lines;
    double t = 0;
    karst::Vec3 from = request.position();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Stop& s = stops[order[i]];
      t += i == 0 ? problem.first_s[order[0]] : problem.leg_s[order[i - 1]][order[i]];
      lines.push_back({from, s.frontier->viewpoint});
      from = s.frontier->viewpoint;
      if (out.size() == static_cast<std::size_t>(goals_)) continue;
      char why[120];
      std::snprintf(why, sizeof why, "stop %zu of %zu, after %.0f s: %.1f m^3 to be seen, %.1f m away", i + 1,
                    order.size(), t, s.weight_m3, s.frontier->path_length_m);
      out.push_back(karst::goal_at(*s.frontier, -t, why));
    }
    request.draw_lines(lines, 0x30a0e0);
    return out;
  }

  karst::OpenFrontiers open_;
  karst::ExpectedGain gain_;
  PathLengths paths_;
  double max_volume_m3_ = 40.0;
  double min_volume_m3_ = 0.2;
  double stop_s_ = 1.5;
  double turn_s_ = 3.0;
  double cruise_ = 0.75;
  double passing_m_ = 3.0;
  double keep_ = 0.03;
  int stops_ = 30;
  int goals_ = 16;
};

}  // namespace

KARST_POLICY(ViewpointTour, "viewpoint_tour", "1.2.0",
             "Plans a tour over viewpoints of all frontiers, what shows much first, anew with each decision.")
