#include "tests/benchmark/offline_bound/tour_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace karst::bound {
namespace {

using Cells = std::set<std::uint32_t>;

/// Places in a square, all joined by straight lines; each sees a few cells of its own and some of its
/// neighbours'.
struct Drawn {
  TourProblem problem;
  std::vector<Cells> seen;
};

void finish(Drawn& d) {
  for (const Cells& cells : d.seen) {
    std::vector<SeenWord> words;
    for (const std::uint32_t c : cells) {
      if (words.empty() || words.back().word != c / 64) words.push_back({c / 64, 0});
      words.back().bits |= std::uint64_t{1} << (c % 64);
    }
    d.problem.seen.push_back(words);
  }
}

Drawn drawn(std::size_t places, std::uint64_t seed) {
  core::Random random(seed);
  Drawn d;
  d.problem.places = places, d.problem.cells = 150;
  std::vector<std::pair<double, double>> at;
  for (std::size_t i = 0; i < places; ++i) at.emplace_back(random.uniform(0, 20), random.uniform(0, 20));
  for (std::size_t a = 0; a < places; ++a) {
    d.problem.near.emplace_back();
    for (std::size_t b = 0; b < places; ++b) {
      d.problem.distance_m.push_back(
          static_cast<float>(std::hypot(at[a].first - at[b].first, at[a].second - at[b].second)));
      d.problem.toward.push_back(static_cast<Place>(a));
      if (a != b) d.problem.near.back().push_back(static_cast<Place>(b));
    }
    Cells cells;
    const std::size_t count = random.bits() % 50;
    while (cells.size() < count) cells.insert(static_cast<std::uint32_t>(random.bits() % d.problem.cells));
    d.seen.push_back(cells);
  }
  finish(d);
  return d;
}

/// The same figure by sets and the law of motion, for places that are joined directly.
double plain_mean(const Drawn& d, const TourTiming& t, const std::vector<Place>& targets) {
  Cells covered = d.seen[0];
  double length_m = 0, area = 0, before_s = 0;
  Place at = 0;
  for (const Place to : targets) {
    length_m += static_cast<double>(d.problem.distance(at, to));
    const double run_up_s = t.speed_mps / t.acceleration_mps2, run_up_m = 0.5 * t.speed_mps * run_up_s;
    const double time_s = t.begin_s + (length_m < run_up_m ? std::sqrt(2 * length_m / t.acceleration_mps2)
                                                           : run_up_s + (length_m - run_up_m) / t.speed_mps);
    if (time_s > t.end_s) break;
    area += static_cast<double>(covered.size()) * (time_s - before_s);
    before_s = time_s, at = to;
    covered.insert(d.seen[to].begin(), d.seen[to].end());
  }
  area += static_cast<double>(covered.size()) * (t.horizon_s - before_s);
  return area / (static_cast<double>(d.problem.cells) * t.horizon_s);
}

const TourTiming kTiming{.speed_mps = 2, .acceleration_mps2 = 2, .begin_s = 1, .end_s = 24, .horizon_s = 30};

TEST(TourSearch, MeanCoverageIsThatOfSetsAndTheLawOfMotion) {
  const Drawn d = drawn(7, 3);
  std::vector<Place> order{1, 2, 3, 4, 5, 6};
  do {
    ASSERT_NEAR(mean_coverage(d.problem, kTiming, order), plain_mean(d, kTiming, order), 1e-9);
  } while (std::next_permutation(order.begin(), order.end()));
}

/// A subset in some order is no better than the same with the others after it.
TEST(TourSearch, FindsTheBestOfAllOrders) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Drawn d = drawn(8, seed);
    std::vector<Place> order(7);
    std::iota(order.begin(), order.end(), Place{1});
    double best = 0;
    do {
      best = std::max(best, plain_mean(d, kTiming, order));
    } while (std::next_permutation(order.begin(), order.end()));
    core::Random random(seed);
    const Tour tour = search_tour(d.problem, kTiming, {.rounds = 5000}, random);
    EXPECT_NEAR(tour.mean_coverage, best, 1e-9);
    EXPECT_NEAR(plain_mean(d, kTiming, tour.targets), best, 1e-9);
  }
}

TEST(TourSearch, IsTheSameForTheSameSeed) {
  const Drawn d = drawn(30, 9);
  core::Random first(4), second(4);
  const Tour a = search_tour(d.problem, kTiming, {.rounds = 2000}, first),
             b = search_tour(d.problem, kTiming, {.rounds = 2000}, second);
  EXPECT_EQ(a.targets, b.targets);
  EXPECT_EQ(a.mean_coverage, b.mean_coverage);
}

/// A corridor 0 - 1 - 2, where each place sees a cell of its own.
TEST(TourSearch, CountsWhatIsPassedOnTheWay) {
  Drawn d;
  d.problem.places = 3, d.problem.cells = 3;
  d.problem.distance_m = {0, 4, 8, 4, 0, 4, 8, 4, 0};
  d.problem.toward = {0, 0, 1, 1, 1, 1, 1, 2, 2};
  d.problem.near = {{1}, {0, 2}, {1}};
  d.seen = {{0}, {1}, {2}};
  finish(d);
  const TourTiming t{.speed_mps = 2, .acceleration_mps2 = 2, .begin_s = 0, .end_s = 10, .horizon_s = 10};
  const std::vector<Place> targets{2};
  EXPECT_EQ(passed(d.problem, t, targets), (std::vector<Place>{0, 1, 2}));
  // From rest, 4 m take 2.5 s, and 8 m take 4.5 s.
  EXPECT_NEAR(mean_coverage(d.problem, t, targets), (2.5 + 2 * 2 + 3 * 5.5) / 30, 1e-12);
}

TEST(TourTiming, LengthIsTheInverseOfArrival) {
  for (double length_m = 0; length_m < 40; length_m += 0.3)
    EXPECT_NEAR(kTiming.length_m(kTiming.arrival_s(length_m)), length_m, 1e-9);
  EXPECT_EQ(kTiming.length_m(0), 0);
  EXPECT_EQ(kTiming.length_m(100), kTiming.length_m(kTiming.end_s));
}

}  // namespace
}  // namespace karst::bound
