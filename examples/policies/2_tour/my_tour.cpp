// A tour over the viewpoints of the nearest frontiers: the order that makes the whole way short.
#include <karst/policy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace {

/// way_m[i][j]: from stop i to stop j. Stop 0 is where the vehicle is.
using PathLengths = std::vector<std::vector<double>>;
using Order = std::vector<std::size_t>;

double length_m(const PathLengths& path_m, const Order& order) {
  double sum = 0;
  for (std::size_t i = 1; i < order.size(); ++i) sum += path_m[order[i - 1]][order[i]];
  return sum;
}

/// The order with stops i to j turned round (2-opt), with stop i moved to place j, and j to i (or-opt).
std::array<Order, 3> changed(const Order& order, std::size_t i, std::size_t j) {
  std::array<Order, 3> out{order, order, order};
  std::reverse(out[0].begin() + i, out[0].begin() + j + 1);
  std::rotate(out[1].begin() + i, out[1].begin() + i + 1, out[1].begin() + j + 1);
  std::rotate(out[2].begin() + i, out[2].begin() + j, out[2].begin() + j + 1);
  return out;
}

/// Always on to the nearest stop; then whatever small change makes the way shorter, until none does.
Order short_tour(const PathLengths& path_m) {
  Order order(path_m.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = 1; i + 1 < order.size(); ++i)
    std::swap(order[i], *std::min_element(order.begin() + i, order.end(), [&](std::size_t a, std::size_t b) {
                return path_m[order[i - 1]][a] < path_m[order[i - 1]][b];
              }));
  for (bool shorter = true; shorter;) {
    shorter = false;
    for (std::size_t i = 1; i + 1 < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size(); ++j)
        for (const Order& other : changed(order, i, j))
          if (length_m(path_m, other) < length_m(path_m, order) - 1e-6) {
            order = other;
            shorter = true;
          }
  }
  return order;
}

class MyTour : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("stops", stops_, 1, 30, "how many viewpoints a tour visits at the most: the nearest ones");
    p.add("min_cells", min_cells_, 1, 10000, "smaller frontiers are ignored: they are seldom openings");
  }

  karst::Decision decide(const karst::Request& request) override {
    const std::vector<karst::Frontier> stops = nearest(request);
    if (stops.empty()) return karst::Decision::explored("no frontier can be reached");
    const PathLengths path_m = lengths(request, stops);
    const Order order = short_tour(path_m);

    std::vector<karst::Goal> goals;
    std::vector<karst_segment_t> drawn;
    karst::Vec3 at = request.position();
    for (std::size_t k = 1; k < order.size(); ++k) {
      const karst::Frontier& f = stops[order[k] - 1];
      char why[120];
      std::snprintf(why, sizeof why, "stop %zu of %zu, a tour of %.0f m", k, stops.size(),
                    length_m(path_m, order));
      goals.push_back(karst::goal_at(f, -static_cast<double>(k), why));
      drawn.push_back({at, f.viewpoint});
      at = f.viewpoint;
    }
    request.draw_lines(drawn, 0x40a0ff);
    return karst::Decision::tour(goals);
  }

 private:
  std::vector<karst::Frontier> nearest(const karst::Request& request) const {
    std::vector<karst::Frontier> stops;
    for (const karst::Frontier& f : request.frontiers)
      if (f.reachable() && f.cells >= static_cast<std::uint32_t>(min_cells_)) stops.push_back(f);
    std::sort(stops.begin(), stops.end(), [](const karst::Frontier& a, const karst::Frontier& b) {
      return a.path_length_m != b.path_length_m ? a.path_length_m < b.path_length_m : a.id < b.id;
    });
    stops.resize(std::min(stops.size(), static_cast<std::size_t>(stops_)));
    return stops;
  }

  /// One question for each stop: a search finds the ways from one place to all the others. The way back to
  /// where the vehicle is does not count, as the tour is open. Where no way is known, it is taken as very
  /// long.
  static PathLengths lengths(const karst::Request& request, const std::vector<karst::Frontier>& stops) {
    std::vector<karst::Vec3> places;
    for (const karst::Frontier& f : stops) places.push_back(f.viewpoint);
    PathLengths path_m(stops.size() + 1, std::vector<double>(stops.size() + 1, 0.0));
    for (std::size_t j = 0; j < stops.size(); ++j) path_m[0][j + 1] = stops[j].path_length_m;
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const std::vector<double> found = request.path_lengths(places[i], places, request.map.resolution_m());
      for (std::size_t j = 0; j < stops.size(); ++j)
        path_m[i + 1][j + 1] = std::isfinite(found[j]) ? found[j] : 1e4;
    }
    return path_m;
  }

  int stops_ = 12;
  int min_cells_ = 10;
};

}  // namespace

KARST_POLICY(MyTour, "my_tour", "0.1.0", "Visits the viewpoints of the nearest frontiers in a short tour.")
