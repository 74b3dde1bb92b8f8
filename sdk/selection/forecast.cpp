#include "sdk/selection/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core_stack/common/options.h"

namespace karst::selection {
namespace {

constexpr double kWhole = 0.99;    // coverage at which a flight finds nothing more to explore
constexpr double kCensored = 0.9;  // of the longest exploration: longer flights were ended by their time

/// Coverage over time of the flights of one contestant in one cave, by a few points.
class CoverageCurve {
 public:
  void add(double t_s, double coverage) {
    if (t_s > points_.back().first && coverage >= points_.back().second) points_.emplace_back(t_s, coverage);
  }
  /// Between the points linear. Beyond the last (T, C) what is left shrinks as it did: (1 - C)^(t / T).
  double at(double t_s) const {
    const auto [last_s, last] = points_.back();
    if (t_s >= last_s) return last_s > 0 ? 1 - std::pow(1 - last, t_s / last_s) : 0;
    const auto next = std::upper_bound(points_.begin(), points_.end(), t_s,
                                       [](double t, const auto& point) { return t < point.first; });
    const auto before = next - 1;
    return before->second +
           (next->second - before->second) * (t_s - before->first) / (next->first - before->first);
  }
  /// When almost all is covered, extrapolated beyond the last point; infinity if that is never.
  double whole_s() const {
    const auto [last_s, last] = points_.back();
    if (!(last > 0)) return std::numeric_limits<double>::infinity();
    return last >= kWhole ? last_s : last_s * std::log(1 - kWhole) / std::log(1 - last);
  }

 private:
  std::vector<std::pair<double, double>> points_{{0, 0}};
};

/// The figures of a contestant at a site by name; NaN without flights.
struct FlightsThere {
  const Experience& experience;
  std::size_t contestant, site;
  double operator[](const char* metric) const {
    const auto found = std::find(experience.metrics.begin(), experience.metrics.end(), metric);
    if (found == experience.metrics.end()) return kUnknown;
    const auto m = static_cast<std::size_t>(found - experience.metrics.begin());
    const Fared& f = experience.at(contestant, site, m);
    return f.flights > 0 ? f.mean : kUnknown;
  }
};

/// The share of the known flights' speed that this vehicle is allowed; at most 1.
double pace_of(const Condition& condition, const FlightTime& time, const std::string& source) {
  for (const auto& [key, text] : condition.mission) {
    if (key != "motion.max_speed") continue;
    double speed_mps = 0;
    core::OptionTable table;
    table.add(key, speed_mps, "m/s", 1e-3, 1e6, "");
    table.set(source, key, text);
    return std::min(1.0, time.max_speed_mps / speed_mps);
  }
  return 1;
}

struct WeightedMean {
  double sum = 0, weight = 0;
  void add(double value, double w) {
    if (std::isnan(value)) return;
    sum += w * value;
    weight += w;
  }
  double value() const { return weight > 0 ? sum / weight : kUnknown; }
};

}  // namespace

Forecast forecast(const Experience& e, const CaveFigures& cave, const Selected& s, std::size_t contestant,
                  const FlightTime& time) {
  WeightedMean coverage, flight, path, energy;
  for (std::size_t site = 0; site < e.sites.size(); ++site) {
    const double weight = s.weights.level[site];
    const FlightsThere there{e, contestant, site};
    const double reached = std::min(there["coverage"], 1 - 1e-6);
    if (!(weight > 0) || std::isnan(reached)) continue;
    const Condition& condition = e.conditions[e.sites[site].condition];
    const double pace = pace_of(condition, time, e.source);
    // The known flights had to return too, and kept as much time for it as this one.
    const double known_s = condition.horizon_s - (time.endurance_s - time.explore_s);
    const double path_m = there["path_length_m"], speed_mps = there["exploring_speed_mps"];
    const double flown_s = std::min(path_m / speed_mps, condition.horizon_s);  // NaN if it is not known
    const bool ended_itself = flown_s < kCensored * condition.horizon_s;
    const double explored_s = std::max(1.0, ended_itself ? std::min(flown_s, known_s) : known_s);
    CoverageCurve curve;
    if (reached > 0.5) curve.add(std::min(there["restricted_t50_s"], explored_s), 0.5);
    if (reached > 0.9) curve.add(std::min(there["restricted_t90_s"], explored_s), 0.9);
    curve.add(explored_s, std::max(0.0, reached));

    // One second here is as much of the cave as this many in the known one.
    const double length_ratio = e.caves[e.sites[site].cave].figures.length_m / cave.length_m;
    const double clock = pace * (std::isnan(length_ratio) ? 1 : length_ratio);
    coverage.add(curve.at(time.explore_s * clock), weight);
    const double whole_s = ended_itself ? flown_s : curve.whole_s();
    const double flight_s = std::min(time.flight_s, whole_s / clock + time.flight_s - time.explore_s);
    flight.add(flight_s, weight);
    path.add(pace * speed_mps * std::max(0.0, flight_s - time.up_down_s), weight);
    energy.add(there["energy_wh"] / flown_s * flight_s, weight);
  }
  return {coverage.value(), flight.value(), path.value(), energy.value()};
}

}  // namespace karst::selection
