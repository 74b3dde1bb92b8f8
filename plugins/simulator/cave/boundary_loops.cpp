#include "plugins/simulator/cave/boundary_loops.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "core_stack/common/decimal_text.h"
#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/joined_vertices.h"

namespace karst::cave {

using core::Vec3;

namespace {

/// An edge as a triangle runs along it.
struct OpenEdge {
  std::uint32_t from, to;
};

std::vector<OpenEdge> open_edges(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_position(mesh);
  // The lower number first, and whether the triangle runs along the edge that way.
  std::vector<std::array<std::uint32_t, 3>> runs;
  runs.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = first[t[i]], b = first[t[(i + 1) % 3]];
      if (a != b) runs.push_back({std::min(a, b), std::max(a, b), a < b ? 1u : 0u});
    }
  std::sort(runs.begin(), runs.end());
  std::vector<OpenEdge> open;
  for (std::size_t i = 0, end = 0; i < runs.size(); i = end) {
    while (end < runs.size() && runs[end][0] == runs[i][0] && runs[end][1] == runs[i][1]) ++end;
    if ((end - i) % 2 == 0) continue;
    const auto& [low, high, up] = runs[i];
    open.push_back(up != 0 ? OpenEdge{low, high} : OpenEdge{high, low});
  }
  return open;
}

/// Takes closed lines off a set of edges until none is left.
class LoopWalk {
 public:
  LoopWalk(std::vector<OpenEdge> edges, std::size_t vertices)
      : edges_(std::move(edges)),
        used_(edges_.size(), false),
        place_(vertices, kNone),
        end_(vertices, kNone) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      ends_.push_back({edges_[e].from, e});
      ends_.push_back({edges_[e].to, e});
    }
    std::sort(ends_.begin(), ends_.end());
    for (std::size_t i = ends_.size(); i-- > 0;) end_[ends_[i].first] = i;
  }

  /// The vertices of each loop, in either direction.
  std::vector<std::vector<std::uint32_t>> loops() {
    std::vector<std::vector<std::uint32_t>> all;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (!used_[e]) walk(edges_[e].from, all);
    return all;
  }

 private:
  using End = std::pair<std::uint32_t, std::size_t>;  // a vertex and an edge there
  static constexpr std::size_t kNone = ~std::size_t{0};

  /// Walks on until there is no way; each time the line meets itself, that part of it is a loop.
  void walk(std::uint32_t begin, std::vector<std::vector<std::uint32_t>>& all) {
    std::vector<std::uint32_t> path{begin};
    place_[begin] = 0;
    for (std::size_t e = unused_at(begin); e < edges_.size(); e = unused_at(path.back())) {
      used_[e] = true;
      const std::uint32_t next = edges_[e].from == path.back() ? edges_[e].to : edges_[e].from;
      const std::size_t met = place_[next];
      if (met == kNone) {
        place_[next] = path.size();
        path.push_back(next);
        continue;
      }
      const auto loop_begin = path.begin() + static_cast<std::ptrdiff_t>(met);
      all.emplace_back(loop_begin, path.end());
      for (std::size_t i = met + 1; i < path.size(); ++i) place_[path[i]] = kNone;
      path.erase(loop_begin + 1, path.end());
    }
    for (const std::uint32_t v : path) place_[v] = kNone;
  }

  /// The number of edges if there is none. An edge once used stays so: each of its ends is passed once.
  std::size_t unused_at(std::uint32_t vertex) {
    std::size_t& at = end_[vertex];
    const auto is_here = [&] { return at < ends_.size() && ends_[at].first == vertex; };
    while (is_here() && used_[ends_[at].second]) ++at;
    return is_here() ? ends_[at].second : edges_.size();
  }

  std::vector<OpenEdge> edges_;
  std::vector<bool> used_;
  std::vector<End> ends_;           // sorted
  std::vector<std::size_t> place_;  // of each vertex in the path; kNone off it
  std::vector<std::size_t> end_;    // of each vertex: where in `ends_` its unused edges may begin
};

/// Half the sum of the cross products of consecutive corners (Newell): its length is the area in the plane
/// across it.
Vec3 area_vector(const std::vector<Vec3>& corners, const Vec3& centre) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += (corners[i] - centre).cross(corners[(i + 1) % corners.size()] - centre);
  return sum / 2;
}

BoundaryLoop measured_loop(const TriangleMesh& mesh, std::vector<std::uint32_t> vertices) {
  BoundaryLoop loop;
  loop.vertices = std::move(vertices);
  std::vector<Vec3> corners;
  for (const std::uint32_t v : loop.vertices) corners.push_back(mesh.vertices[v].cast<double>());
  double length_m = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    loop.centre += (b - a).norm() * (a + b) / 2;
    length_m += (b - a).norm();
  }
  loop.centre /= length_m;
  for (const Vec3& c : corners) loop.diameter_m = std::max(loop.diameter_m, 2 * (c - loop.centre).norm());
  const Vec3 area = area_vector(corners, loop.centre);
  loop.area_m2 = area.norm();
  if (loop.area_m2 > 0) loop.normal = area / loop.area_m2;
  return loop;
}

std::string two_digits(double v) { return core::format_text(v < 99 ? "%.2g" : "%.0f", v); }

/// The open edges as pairs in the direction in which the triangles run, sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> directions(const std::vector<OpenEdge>& edges) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
  for (const OpenEdge& e : edges) all.emplace_back(e.from, e.to);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const TriangleMesh& mesh) {
  const std::vector<OpenEdge> edges = open_edges(mesh);
  const auto runs = directions(edges);
  std::vector<BoundaryLoop> loops;
  for (std::vector<std::uint32_t>& vertices : LoopWalk(edges, mesh.vertices.size()).loops()) {
    std::size_t along = 0;  // edges that the mesh's own triangles run along as the loop does
    for (std::size_t i = 0; i < vertices.size(); ++i)
      along += std::binary_search(runs.begin(), runs.end(),
                                  std::pair(vertices[i], vertices[(i + 1) % vertices.size()]));
    if (2 * along > vertices.size()) std::reverse(vertices.begin(), vertices.end());
    loops.push_back(measured_loop(mesh, std::move(vertices)));
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const BoundaryLoop& a, const BoundaryLoop& b) { return a.area_m2 > b.area_m2; });
  return loops;
}

const BoundaryLoop* nearest_loop(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                 const Vec3& place) {
  const BoundaryLoop* best = nullptr;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const BoundaryLoop& loop : loops)
    for (const std::uint32_t v : loop.vertices)
      if (const double m2 = (mesh.vertices[v].cast<double>() - place).squaredNorm(); m2 < least_m2) {
        least_m2 = m2;
        best = &loop;
      }
  return best;
}

const BoundaryLoop* loop_towards(const std::vector<BoundaryLoop>& loops, const Vec3& from,
                                 const Vec3& direction) {
  const BoundaryLoop* best = nullptr;
  double greatest_cosine = -2;
  for (const BoundaryLoop& loop : loops)
    if (const double cosine = (loop.centre - from).normalized().dot(direction); cosine > greatest_cosine) {
      greatest_cosine = cosine;
      best = &loop;
    }
  return best;
}

std::string size_and_place(const BoundaryLoop& loop) {
  return two_digits(loop.diameter_m) + " m across, " + two_digits(loop.area_m2) + " m², around " +
         core::decimal_text(loop.centre, 1);
}

std::string hole_text(const BoundaryLoop* loop) {
  if (loop == nullptr) return "; no edge is open: parts of the mesh do not touch each other there";
  return core::format_text(
      "; the open edges nearest to it are a loop of %zu, %s. `karst cave info CAVE --cap OUT.ply` closes "
      "such loops",
      loop->vertices.size(), size_and_place(*loop).c_str());
}

}  // namespace karst::cave
