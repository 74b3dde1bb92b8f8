// How fast the vehicle could explore a cave if it knew it: a tour by a point mass at the limits of speed and
// acceleration, found by annealing over orders of viewpoints. See docs/results/offline_bound.md.
#include <cstdio>
#include <exception>
#include <fstream>

#include "core_stack/common/error.h"
#include "tests/benchmark/offline_bound/arguments.h"
#include "tests/benchmark/offline_bound/flown_curve.h"
#include "tests/benchmark/offline_bound/view_graph.h"
#include "tests/benchmark/times.h"

namespace karst::bound {
namespace {

using core::Vec3;

constexpr double kLookPeriod_s = 0.4;  // every second sweep of the LiDAR
/// Coverage is counted over one cell in 8, the search counts one in 64: samples to a few per mille.
constexpr int kCounted = 2, kSearched = 4;

struct World {
  cave::Cave cave;
  std::vector<Eye> eyes;
  evaluation::Reachable reachable;
  double cell_m3 = 0;
  std::vector<Vec3> centres;  // of the cells of R that are counted
  ViewGraph graph;
  TourProblem problem;

  Curve curve(const std::vector<Look>& looks) const {
    return curve_of(cave.scene, eyes, centres, cell_m3, looks);
  }
};

std::vector<Vec3> sample_of(const evaluation::Reachable& r, int stride) {
  std::vector<Vec3> sample;
  r.reachable.for_each([&](const core::CellKey& k) {
    if (k.x % stride == 0 && k.y % stride == 0 && k.z % stride == 0)
      sample.push_back(evaluation::center_of(k, r.options.resolution_m));
  });
  return sample;
}

TourProblem problem_of(const World& w, const std::vector<Vec3>& sample) {
  TourProblem p;
  p.places = w.graph.places.size(), p.cells = sample.size();
  p.near = w.graph.near;
  std::vector<std::uint32_t> all(sample.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  for (const Vec3& place : w.graph.places) {
    std::vector<SeenWord> words;
    for (const std::uint32_t cell : seen_from(w.cave.scene, w.eyes, place, sample, all)) {
      if (words.empty() || words.back().word != cell / 64) words.push_back({cell / 64, 0});
      words.back().bits |= std::uint64_t{1} << (cell % 64);
    }
    p.seen.push_back(std::move(words));
  }
  return p;
}

World world_of(const Arguments& a) {
  World w{.cave = cave::load_cave(a.cave, a.start),
          .eyes = eyes_of(a.vehicle, a.mapping_range_m),
          .reachable = {},
          .centres = {},
          .graph = {},
          .problem = {}};
  if (w.eyes.empty()) throw core::InputError(a.cave, "", "the vehicle has no LiDAR");
  const Vec3& start = w.cave.description.start.position;
  w.reachable = evaluation::find_reachable(w.cave.scene.mesh(), start, {}, a.cave);
  const evaluation::Reachable& r = w.reachable;
  w.centres = sample_of(r, kCounted);
  w.cell_m3 = r.volume_m3() / static_cast<double>(w.centres.size());
  const double graph_ms = core::bench::cpu_ms([&] { w.graph = view_graph(r, start, a.spacing_m); });
  const std::vector<Vec3> sample = sample_of(r, kSearched);
  const double sight_ms = core::bench::cpu_ms([&] { w.problem = problem_of(w, sample); });
  w.problem.distance_m = std::move(w.graph.distance_m);
  w.problem.toward = std::move(w.graph.toward);
  std::printf(
      "%s: R %.0f m^3; %zu viewpoints, %zu left out, %.1f %% of the flyable cells near one; "
      "%zu cells in the search; paths %.0f s, sight %.0f s\n",
      a.cave.c_str(), r.volume_m3(), w.problem.places, w.graph.left_out, 100 * w.graph.flyable_near,
      w.problem.cells, graph_ms / 1e3, sight_ms / 1e3);
  return w;
}

/// The best of several restarts, and how far they are apart.
Curve bound(const World& w, const TourTiming& timing, const Arguments& a) {
  Tour best;
  std::printf("  restarts at %.2f m/s:", timing.speed_mps);
  const double ms = core::bench::cpu_ms([&] {
    for (int i = 0; i < a.restarts; ++i) {
      core::Random random = core::Random::stream(a.seed + static_cast<std::uint64_t>(i), "tour");
      const Tour tour = search_tour(w.problem, timing, a.search, random);
      std::printf(" %.4f", tour.mean_coverage);
      if (tour.mean_coverage > best.mean_coverage) best = tour;
    }
  });
  std::printf("  (%.0f s)\n", ms / 1e3);
  TourTiming longer = timing;  // a way pulled taut leads farther in the same time
  longer.end_s *= 1.1;
  const std::vector<Place> way = passed(w.problem, longer, best.targets);
  Curve curve =
      w.curve(looks_along(pulled_taut(w.reachable, w.graph, way, best.targets), timing, kLookPeriod_s));
  std::vector<Vec3> places;
  for (const Place p : way) places.push_back(w.graph.places[p]);
  Curve as_found = w.curve(looks_along(places, timing, kLookPeriod_s));
  return evaluation::mean_coverage(curve, timing.horizon_s) >
                 evaluation::mean_coverage(as_found, timing.horizon_s)
             ? curve
             : as_found;
}

struct Row {
  const char* name;
  Curve curve;
};

std::string time_text(const Curve& curve, double fraction) {
  char text[16];
  const auto t = evaluation::time_of_coverage(curve, fraction);
  std::snprintf(text, sizeof text, t ? "%.1f" : "-", t.value_or(0));
  return text;
}

void print(const std::vector<Row>& rows, double horizon_s) {
  const auto auc = [&](const Row& r) { return evaluation::mean_coverage(r.curve, horizon_s).value_or(0); };
  std::printf("  %-36s %8s %8s %8s %8s %8s %8s\n", "", "auc", "of bound", "t50 s", "t90 s", "t95 s", "end");
  for (const Row& r : rows)
    std::printf("  %-36s %8.4f %7.1f%% %8s %8s %8s %8.4f\n", r.name, auc(r), 100 * auc(r) / auc(rows.back()),
                time_text(r.curve, 0.5).c_str(), time_text(r.curve, 0.9).c_str(),
                time_text(r.curve, 0.95).c_str(), r.curve.back().coverage);
}

using Tables = std::vector<std::pair<std::string, std::vector<Row>>>;

void write_csv(const std::string& file, const Tables& tables) {
  std::ofstream out(file);
  out << "run,row,time_s,coverage\n";
  char line[64];
  for (const auto& [name, rows] : tables)
    for (const Row& r : rows)
      for (const evaluation::CoveragePoint& p : r.curve) {
        std::snprintf(line, sizeof line, ",%.3f,%.6f\n", p.time_s, p.coverage);
        out << name << ",\"" << r.name << '"' << line;
      }
  if (!out.flush()) throw core::InputError(file, "", "cannot be written");
}

std::vector<Row> rows_of(const World& w, const Flown& f, const Arguments& a) {
  const TourTiming& t = f.timing;
  TourTiming slow = t;
  slow.speed_mps = f.speed_mps;
  const double begin_s = f.begin_s, landed_s = f.record.last_time_s();
  const std::vector<Vec3> way = way_of(f.record.truth, begin_s + t.begin_s, f.explored_s);
  return {
      {"the run as recorded", evaluation::coverage_curve(f.record, f.metrics["coverage"].get<double>())},
      {"its way as flown, in the model", w.curve(looks_of(f.record.truth, begin_s, landed_s, kLookPeriod_s))},
      {"its way at the speed limit", w.curve(looks_along(way, t, kLookPeriod_s))},
      {"bound at the run's mean speed", bound(w, slow, a)},
      {"bound", bound(w, t, a)}};
}

void head(const std::string& name, const TourTiming& t) {
  std::printf("%s: moves from %.1f s to %.1f s of %.0f s, counted from take-off; %.2f m/s^2\n", name.c_str(),
              t.begin_s, t.end_s, t.horizon_s, t.acceleration_mps2);
}

void run(const Arguments& a) {
  const World w = world_of(a);
  Tables tables;
  for (const Flown& f : a.runs) {
    const std::string name = f.record.directory.filename().string();
    head(name, f.timing);
    tables.emplace_back(name, rows_of(w, f, a));
    print(tables.back().second, f.timing.horizon_s);
  }
  if (a.runs.empty()) {
    head(a.cave, a.timing);
    tables.push_back({a.cave, {{"bound", bound(w, a.timing, a)}}});
    print(tables.back().second, a.timing.horizon_s);
  }
  if (!a.csv.empty()) write_csv(a.csv, tables);
}

}  // namespace
}  // namespace karst::bound

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    karst::bound::run(karst::bound::arguments_of(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
