#include "tests/benchmark/offline_bound/tour_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace karst::bound {
namespace {

using Bits = std::vector<std::uint64_t>;

std::size_t words_of(const TourProblem& p) { return (p.cells + 63) / 64; }

std::size_t add(const std::vector<SeenWord>& seen, Bits& covered) {
  std::size_t added = 0;
  for (const SeenWord& s : seen) {
    std::uint64_t& w = covered[s.word];
    added += static_cast<std::size_t>(std::popcount(s.bits & ~w));
    w |= s.bits;
  }
  return added;
}

std::size_t count_new(const std::vector<SeenWord>& seen, const Bits& covered) {
  std::size_t n = 0;
  for (const SeenWord& s : seen) n += static_cast<std::size_t>(std::popcount(s.bits & ~covered[s.word]));
  return n;
}

/// The flight as far as one target.
struct State {
  Bits covered;
  std::size_t count = 0;
  double area = 0;  // cells times seconds until time_s
  double length_m = 0, time_s = 0;
  Place at = 0;
  bool over = false;  // the time was over on the way here
};

State at_start(const TourProblem& p, const TourTiming& t) {
  State s;
  s.covered.assign(words_of(p), 0);
  s.at = p.start;
  s.count = add(p.seen[p.start], s.covered);
  s.time_s = t.begin_s;
  s.area = static_cast<double>(s.count) * t.begin_s;
  return s;
}

template <class Visit>
void fly_to(const TourProblem& p, const TourTiming& t, Place target, State& s, const Visit& visit) {
  while (s.at != target && !s.over) {
    const Place next = p.next(s.at, target);
    const double length_m = s.length_m + static_cast<double>(p.distance(s.at, next));
    const double time_s = t.arrival_s(length_m);
    if (time_s > t.end_s) {
      s.over = true;
      return;
    }
    s.area += static_cast<double>(s.count) * (time_s - s.time_s);
    s.length_m = length_m, s.time_s = time_s, s.at = next;
    s.count += add(p.seen[next], s.covered);
    visit(next);
  }
}

double mean_of(const TourProblem& p, const TourTiming& t, const State& s) {
  const double area = s.area + static_cast<double>(s.count) * (t.horizon_s - s.time_s);
  return area / (static_cast<double>(p.cells) * t.horizon_s);
}

class Annealing {
 public:
  Annealing(const TourProblem& p, const TourTiming& t, core::Random& random) : p_(p), t_(t), random_(random) {
    states_.push_back(at_start(p, t));
  }

  Tour run(const SearchOptions& o) {
    current_ = greedy();
    double value = accept(current_, 0);
    best_ = {value, current_};
    for (int i = 0; i < o.rounds; ++i) {
      const double temperature =
          o.first_temperature * std::pow(o.last_temperature / o.first_temperature, double(i) / o.rounds);
      std::vector<Place> changed = current_;
      change(changed);
      const auto [same, end] =
          std::mismatch(current_.begin(), current_.end(), changed.begin(), changed.end());
      const auto first = static_cast<std::size_t>(same - current_.begin());
      if (same == current_.end() && end == changed.end()) continue;
      const double other = value_from(changed, first);
      if (other < value && random_.uniform() >= std::exp((other - value) / temperature)) continue;
      value = other;
      current_ = std::move(changed);
      accept(current_, first);
      if (value > best_.mean_coverage) best_ = {value, current_};
    }
    return best_;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_.bits() % n); }
  Place any_place() { return static_cast<Place>(below(p_.places)); }

  std::vector<Place> greedy() {
    const double exponent = random_.uniform(0.5, 1.5);
    State s = states_.front();
    std::vector<Place> targets;
    while (!s.over) {
      double best = 0;
      Place target = s.at;
      for (std::size_t i = 0; i < p_.places; ++i) {
        const auto place = static_cast<Place>(i);
        if (place == s.at) continue;
        const double gain = static_cast<double>(count_new(p_.seen[place], s.covered)) /
                            std::pow(static_cast<double>(p_.distance(s.at, place)), exponent);
        if (gain > best) best = gain, target = place;
      }
      if (target == s.at) break;
      targets.push_back(target);
      fly_to(p_, t_, target, s, [](Place) {});
    }
    return targets;
  }

  /// Of an order whose first targets are those of the current one.
  double value_from(const std::vector<Place>& targets, std::size_t first) {
    first = std::min(first, states_.size() - 1);
    scratch_ = states_[first];
    for (std::size_t i = first; i < targets.size() && !scratch_.over; ++i)
      fly_to(p_, t_, targets[i], scratch_, [](Place) {});
    return mean_of(p_, t_, scratch_);
  }

  /// Keeps the states after each target; drops targets far beyond the end of the time, but a few, because a
  /// shorter way before them brings them back.
  double accept(std::vector<Place>& targets, std::size_t first) {
    constexpr std::size_t kSpare = 6;
    states_.resize(std::min(states_.size(), first + 1));
    for (std::size_t i = states_.size() - 1; i < targets.size() && !states_.back().over; ++i) {
      states_.push_back(states_.back());
      fly_to(p_, t_, targets[i], states_.back(), [](Place) {});
    }
    targets.resize(std::min(targets.size(), states_.size() - 1 + kSpare));
    return mean_of(p_, t_, states_.back());
  }

  double extra_m(const std::vector<Place>& targets, std::size_t at, Place place) const {
    const Place before = at == 0 ? p_.start : targets[at - 1];
    const double there = static_cast<double>(p_.distance(before, place));
    if (at == targets.size()) return there;
    return there + static_cast<double>(p_.distance(place, targets[at])) -
           static_cast<double>(p_.distance(before, targets[at]));
  }

  void insert_cheaply(std::vector<Place>& targets, Place place) const {
    double least = std::numeric_limits<double>::infinity();
    std::size_t where = 0;
    for (std::size_t i = 0; i <= targets.size(); ++i)
      if (const double extra = extra_m(targets, i, place); extra < least) least = extra, where = i;
    targets.insert(targets.begin() + static_cast<std::ptrdiff_t>(where), place);
  }

  /// Of a few places, the one that shows the most of what the current flight leaves unseen.
  Place missing_place() {
    constexpr int kDrawn = 6;
    Place best = any_place();
    std::size_t most = 0;
    for (int i = 0; i < kDrawn; ++i) {
      const Place place = any_place();
      const std::size_t n = count_new(p_.seen[place], states_.back().covered);
      if (n > most) most = n, best = place;
    }
    return best;
  }

  void insert(std::vector<Place>& targets) {
    const Place place = random_.uniform() < 0.5 ? missing_place() : any_place();
    if (random_.uniform() < 0.7) return insert_cheaply(targets, place);
    targets.insert(targets.begin() + static_cast<std::ptrdiff_t>(below(targets.size() + 1)), place);
  }

  /// Moves a stretch to another position, at times turned round.
  void move_stretch(std::vector<Place>& targets) {
    const std::size_t length = 1 + below(std::min<std::size_t>(targets.size(), 5));
    const std::size_t from = below(targets.size() - length + 1);
    const auto begin = targets.begin() + static_cast<std::ptrdiff_t>(from);
    std::vector<Place> stretch(begin, begin + static_cast<std::ptrdiff_t>(length));
    targets.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
    if (random_.uniform() < 0.5) std::reverse(stretch.begin(), stretch.end());
    targets.insert(targets.begin() + static_cast<std::ptrdiff_t>(below(targets.size() + 1)), stretch.begin(),
                   stretch.end());
  }

  void turn_round(std::vector<Place>& targets) {
    std::size_t i = below(targets.size()), j = below(targets.size());
    if (i > j) std::swap(i, j);
    std::reverse(targets.begin() + static_cast<std::ptrdiff_t>(i),
                 targets.begin() + static_cast<std::ptrdiff_t>(j + 1));
  }

  void ruin_and_recreate(std::vector<Place>& targets) {
    const std::size_t length = 1 + below(std::min<std::size_t>(targets.size(), 8));
    const auto begin = targets.begin() + static_cast<std::ptrdiff_t>(below(targets.size() - length + 1));
    std::vector<Place> taken(begin, begin + static_cast<std::ptrdiff_t>(length));
    targets.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
    for (std::size_t i = taken.size(); i > 1; --i) std::swap(taken[i - 1], taken[below(i)]);
    for (const Place place : taken)
      if (random_.uniform() < 0.8) insert_cheaply(targets, place);
  }

  void change(std::vector<Place>& targets) {
    const double draw = random_.uniform();
    if (targets.empty() || draw < 0.2) return insert(targets);
    if (draw < 0.35) {
      targets.erase(targets.begin() + static_cast<std::ptrdiff_t>(below(targets.size())));
    } else if (draw < 0.6) {
      Place& place = targets[below(targets.size())];
      if (!p_.near[place].empty()) place = p_.near[place][below(p_.near[place].size())];
    } else if (draw < 0.8) {
      move_stretch(targets);
    } else if (draw < 0.9) {
      turn_round(targets);
    } else {
      ruin_and_recreate(targets);
    }
  }

  const TourProblem& p_;
  const TourTiming& t_;
  core::Random& random_;
  std::vector<Place> current_;
  std::vector<State> states_;  // of the current order: before the first target, after each
  State scratch_;
  Tour best_;
};

}  // namespace

double TourTiming::arrival_s(double length_m) const {
  const double run_up_m = speed_mps * speed_mps / (2 * acceleration_mps2);
  if (length_m < run_up_m) return begin_s + std::sqrt(2 * length_m / acceleration_mps2);
  return begin_s + speed_mps / acceleration_mps2 + (length_m - run_up_m) / speed_mps;
}

double TourTiming::length_m(double time_s) const {
  const double t = std::clamp(time_s, begin_s, end_s) - begin_s, run_up_s = speed_mps / acceleration_mps2;
  if (t < run_up_s) return 0.5 * acceleration_mps2 * t * t;
  return speed_mps * (t - 0.5 * run_up_s);
}

std::vector<Place> passed(const TourProblem& p, const TourTiming& t, std::span<const Place> targets) {
  std::vector<Place> out{p.start};
  State s = at_start(p, t);
  for (const Place target : targets) fly_to(p, t, target, s, [&](Place place) { out.push_back(place); });
  return out;
}

double mean_coverage(const TourProblem& p, const TourTiming& t, std::span<const Place> targets) {
  State s = at_start(p, t);
  for (const Place target : targets) fly_to(p, t, target, s, [](Place) {});
  return mean_of(p, t, s);
}

Tour search_tour(const TourProblem& p, const TourTiming& t, const SearchOptions& options,
                 core::Random& random) {
  return Annealing(p, t, random).run(options);
}

}  // namespace karst::bound
