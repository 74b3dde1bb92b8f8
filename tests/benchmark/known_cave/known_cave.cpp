// A policy that knows the cave, to judge what others expect of it: what lies behind each frontier in truth,
// beside the expected gain. For evaluation only (docs/results/expected_gain.md).
//
// KNOWN_CAVE names the points of the cave (reachable_points). KNOWN_CAVE_LOG, if set, takes a line for each
// frontier of every fourth decision. The policy flies to the most volume for the time it takes, as expected,
// or in truth with `knows`.
#include <karst/expected_gain.h>
#include <karst/ranking.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <unordered_map>

namespace {

/// The points of the cave on a grid, and which of them the map has shown.
class Cave {
 public:
  static constexpr double spacing_m = 0.4;

  explicit Cave(const char* file) {
    std::ifstream in(file, std::ios::binary);
    std::array<float, 3> p{};
    while (in.read(reinterpret_cast<char*>(p.data()), sizeof p)) points_.push_back({p[0], p[1], p[2]});
    if (points_.empty()) throw karst::Error("KNOWN_CAVE names no file of points");
    for (std::size_t i = 0; i < points_.size(); ++i) at_[key(place(points_[i]))] = i;
    seen_.assign(points_.size(), false);
    reached_by_.assign(points_.size(), 0);
  }

  void note(const karst::MapView& map) {
    std::vector<karst::Vec3> unseen;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (!seen_[i]) unseen.push_back(points_[i]), numbers.push_back(i);
    const std::vector<karst::Cell> cells = map.cells(unseen);
    for (std::size_t i = 0; i < cells.size(); ++i) seen_[numbers[i]] = cells[i] == karst::Cell::free;
  }

  struct Behind {
    double near_m3 = 0, far_m3 = 0;  // within 5 m and 20 m of the frontier, along ways through unseen space
    double farthest_m = 0;           // such a way, at most 20 m
  };
  Behind behind(const karst::Frontier& f) {
    constexpr double around_m = 0.5, near_m = 5, far_m = 20;
    constexpr double point_m3 = spacing_m * spacing_m * spacing_m;
    ++last_;
    std::deque<std::pair<std::size_t, double>> open;
    const auto reach = [&](const Place& p, double way_m) {
      const auto found = at_.find(key(p));
      if (found == at_.end() || seen_[found->second] || reached_by_[found->second] == last_) return;
      reached_by_[found->second] = last_;
      open.emplace_back(found->second, way_m);
    };
    const karst::Vec3 around{around_m, around_m, around_m};
    const Place low = place(f.low - around), high = place(f.high + around);
    for (long x = low[0]; x <= high[0]; ++x)
      for (long y = low[1]; y <= high[1]; ++y)
        for (long z = low[2]; z <= high[2]; ++z) reach({x, y, z}, 0);
    Behind out;
    while (!open.empty()) {
      const auto [i, way_m] = open.front();
      open.pop_front();
      (way_m <= near_m ? out.near_m3 : out.far_m3) += point_m3;
      out.farthest_m = way_m;
      if (way_m + spacing_m > far_m) continue;
      const Place p = place(points_[i]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const long step : {-1L, 1L}) {
          Place next = p;
          next[axis] += step;
          reach(next, way_m + spacing_m);
        }
    }
    out.far_m3 += out.near_m3;
    return out;
  }

 private:
  using Place = std::array<long, 3>;
  static Place place(const karst::Vec3& p) {
    const auto on_grid = [](double v) { return std::lround((v - 0.1) / spacing_m); };
    return {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
  }
  static std::uint64_t key(const Place& p) {
    std::uint64_t k = 0;
    for (const long v : p) k = k << 21 | static_cast<std::uint64_t>(v + (1 << 20));
    return k;
  }

  std::vector<karst::Vec3> points_;
  std::unordered_map<std::uint64_t, std::size_t> at_;
  std::vector<bool> seen_;
  std::vector<std::uint32_t> reached_by_;
  std::uint32_t last_ = 0;
};

class KnownCave : public karst::Policy {
 public:
  KnownCave() {
    by_openings_.share = 0;
    ranking_.path_weight = ranking_.turn_cost_m = ranking_.keep_bonus_m = 0;
    ranking_.horizon_m = 1e6;
    if (const char* file = std::getenv("KNOWN_CAVE")) cave_.emplace(file);
    if (const char* file = std::getenv("KNOWN_CAVE_LOG")) log_.reset(std::fopen(file, "w"));
    if (log_) std::fprintf(log_.get(), "decision,frontier,cells,by_openings_m3,expected_m3,near_m3,far_m3\n");
  }

  void parameters(karst::Parameters& p) override {
    p.add("knows", knows_, "choose by what lies behind a frontier in truth");
  }
  void on_event(const karst::Event& event) override { ranking_.on_event(event); }

  karst::Decision decide(const karst::Request& request) override {
    if (!cave_) throw karst::Error("KNOWN_CAVE is not set");
    cave_->note(request.map);
    std::vector<const karst::Frontier*> all;
    for (const karst::Frontier& f : request.frontiers)
      if (f.reachable()) all.push_back(&f);
    const std::vector<double> expected_m3 = expected_.volumes_m3(request, all),
                              by_openings_m3 = by_openings_.volumes_m3(request, all);
    std::unordered_map<std::uint32_t, double> rate;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const karst::Frontier& f = *all[i];
      const Cave::Behind truth = cave_->behind(f);
      if (log_ && request.sequence % 4 == 0)
        std::fprintf(log_.get(), "%u,%u,%u,%.3f,%.3f,%.3f,%.3f\n", request.sequence, f.id, f.cells,
                     by_openings_m3[i], expected_m3[i], truth.near_m3, truth.far_m3);
      const double speed_mps = 0.75 * request.max_speed_mps;
      double time_s = 1.5 + f.path_length_m / speed_mps + 3 * karst::turn_fraction(request, f);
      if (knows_) time_s += truth.farthest_m / speed_mps;
      rate[f.id] = (knows_ ? truth.far_m3 : expected_m3[i]) / time_s;
      if (karst::under_way(request, f)) rate[f.id] *= 1.3;
    }
    if (log_) std::fflush(log_.get());
    return ranking_.decide(request, [&](const karst::Frontier& f) {
      return karst::Merit{rate.at(f.id), "most for the time"};
    });
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::optional<Cave> cave_;
  std::unique_ptr<std::FILE, Close> log_;
  karst::ExpectedGain expected_, by_openings_;
  karst::Ranking ranking_;
  bool knows_ = false;
};

}  // namespace

KARST_POLICY(KnownCave, "known_cave", "1.0.0", "Knows the cave: for evaluation only.")
