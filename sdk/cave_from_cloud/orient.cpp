#include "sdk/cave_from_cloud/orient.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "sdk/cave_from_cloud/signed_sets.h"

namespace karst::from_cloud {

using core::Vec3;
using core::Vec3f;

namespace {

/// What lines meet: the points, each a ball of the radius of their spacing.
struct Rock {
  const core::PointTree& tree;
  double spacing_m;

  double own_wall_m() const { return 3 * spacing_m; }  // near a point, a line meets the wall it lies on
  /// By sphere tracing.
  bool blocks(const Vec3& from, const Vec3& to) const {
    const double length_m = (to - from).norm();
    const Vec3 direction = (to - from) / length_m;
    for (double at_m = 0; at_m < length_m;) {
      const auto nearest = tree.nearest(from + at_m * direction);
      if (!nearest || nearest->distance_m < spacing_m) return nearest.has_value();
      at_m += std::max(nearest->distance_m - spacing_m, spacing_m / 2);
    }
    return false;
  }
};

/// The places in the air from which points were measured.
class Views {
 public:
  Views(const std::vector<Vec3>& places, const Rock& rock) : rock_(rock), tree_(floats_of(places)) {}

  /// 1 if the normal points to a view that sees the point, -1 if it points away, 0 if no view sees it, or at
  /// a grazing angle only.
  int sign_at(const Vec3f& point, const Vec3f& normal) const {
    constexpr std::size_t kTried = 4;
    constexpr double kFarthest_m = 50, kGrazing = 0.3;
    const Vec3 p = point.cast<double>();
    for (const std::uint32_t i : tree_.nearest_few(p, kTried)) {
      const Vec3 view = tree_.points()[i].cast<double>(), to_view = view - p;
      const double range_m = to_view.norm();
      if (range_m > kFarthest_m || range_m <= rock_.own_wall_m()) continue;
      const double cosine = normal.cast<double>().dot(to_view) / range_m;
      if (std::abs(cosine) < kGrazing || rock_.blocks(view, p + rock_.own_wall_m() / range_m * to_view))
        continue;
      return cosine > 0 ? 1 : -1;
    }
    return 0;
  }

 private:
  static std::vector<Vec3f> floats_of(const std::vector<Vec3>& places) {
    std::vector<Vec3f> out;
    for (const Vec3& p : places) out.push_back(p.cast<float>());
    return out;
  }

  const Rock& rock_;
  core::PointTree tree_;
};

struct Edge {
  float cost;
  std::uint32_t a, b;
  bool opposed;  // the normals at its ends
};

/// Kruskal's algorithm: the cheapest edges first that join two trees.
void join_neighbours(const std::vector<Vec3f>& normals, const Neighbours& neighbours, SignedSets& trees) {
  std::vector<Edge> edges;
  for (std::uint32_t a = 0; a < normals.size(); ++a)
    for (const std::uint32_t b : neighbours.of(a)) {
      if (a == b) continue;
      const float cosine = normals[a].dot(normals[b]);
      edges.push_back({1 - std::abs(cosine), a, b, cosine < 0});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::tie(x.cost, x.a, x.b) < std::tie(y.cost, y.a, y.b);
  });
  for (const Edge& e : edges) trees.unite(e.a, e.b, e.opposed);
}

/// 1 if other rock lies on the normal's side only, -1 if on the other side only, else 0.
int side_of_rock(const Rock& rock, const Vec3f& point, const Vec3f& normal) {
  constexpr double kFarthest_m = 30;
  const Vec3 p = point.cast<double>(), n = normal.cast<double>();
  const auto meets = [&](double sign) {
    return rock.blocks(p + sign * rock.own_wall_m() * n, p + sign * kFarthest_m * n);
  };
  return (meets(1) ? 1 : 0) - (meets(-1) ? 1 : 0);
}

struct Ballot {
  std::size_t passed = 0;  // points of the tree so far
  std::size_t ahead = 0, behind = 0;
};

}  // namespace

Orientation orient(const core::PointTree& tree, const Neighbours& neighbours, const std::vector<Vec3>& views,
                   double spacing_m, std::vector<Vec3f>& normals) {
  constexpr std::size_t kVoters = 20000;  // of a spanning tree
  const std::vector<Vec3f>& points = tree.points();
  const Rock rock{tree, spacing_m};
  const auto count = static_cast<std::uint32_t>(points.size());
  const std::uint32_t air = count;  // a member beside the points, whose sign is that of normals into the air
  SignedSets trees(points.size() + 1);
  Orientation result;
  if (!views.empty()) {
    const Views from(views, rock);
    for (std::uint32_t i = 0; i < count; ++i)
      if (const int sign = from.sign_at(points[i], normals[i]); sign != 0) {
        trees.unite(i, air, sign < 0);
        ++result.seen;
      }
  }
  join_neighbours(normals, neighbours, trees);

  const SignedSets::Root known = trees.root(air);
  std::vector<Ballot> ballots(points.size() + 1);  // of each root
  for (std::uint32_t i = 0; i < count; ++i) {
    const SignedSets::Root root = trees.root(i);
    if (root.index == known.index) continue;
    Ballot& ballot = ballots[root.index];
    if (ballot.passed++ % (trees.size_of_set(i) / kVoters + 1) != 0) continue;
    const int side = side_of_rock(rock, points[i], root.differs ? Vec3f(-normals[i]) : normals[i]);
    if (side > 0) ++ballot.ahead;
    if (side < 0) ++ballot.behind;
  }
  for (const Ballot& b : ballots) {
    result.rays += b.ahead + b.behind;
    result.agreed += std::max(b.ahead, b.behind);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const SignedSets::Root root = trees.root(i);
    const Ballot& b = ballots[root.index];
    const bool root_differs = root.index == known.index ? known.differs : b.behind > b.ahead;
    if (root.differs != root_differs) normals[i] = -normals[i];
  }
  return result;
}

}  // namespace karst::from_cloud
