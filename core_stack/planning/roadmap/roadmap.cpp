#include "core_stack/planning/roadmap/roadmap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core_stack/planning/roadmap/roadmap_graph.h"
#include "core_stack/planning/roadmap/roadmap_path.h"

namespace karst::core {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Goals nearer than this are also checked directly: the zigzag of the graph would matter there.
constexpr double kDirect_m = 5.0;

/// First radius of the search for a clear place near a goal that is not clear.
constexpr double kFirstShell_m = 1.6;

/// Number of blocks of 4 x 4 x 4 cells in the cube around a ball.
double blocks_within(double radius_m, double resolution_m) {
  return std::pow(2 * radius_m / (4 * resolution_m) + 2, 3);
}

/// One A* search over the graph from several joins; heuristic: straight-line distance to the target.
class GraphSearch {
 public:
  explicit GraphSearch(const RoadmapGraph& graph, EqualPaths equal = EqualPaths::as_stored)
      : graph_(graph), links_(graph.links()), equal_(equal) {
    std::uint32_t count = 0;
    for (const RoadmapTile& t : graph.tiles) {
      base_.push_back(count);
      count += static_cast<std::uint32_t>(t.nodes.size());
    }
    length_.assign(count, kInf);
    parent_.assign(count, kNone);
    done_.assign(count, false);
  }

  /// Runs until `settled(index, length)` returns true. Without a target it is Dijkstra's search.
  template <class Settled>
  void run(const std::vector<Join>& from, const std::optional<Vec3>& target, Settled&& settled) {
    const auto rest = [&](const Vec3& p) { return target ? (*target - p).norm() : 0.0; };
    for (const Join& j : from) {
      const std::uint32_t i = index_of(j.node);
      if (j.length_m >= length_[i]) continue;
      length_[i] = j.length_m;
      push({j.length_m + rest(graph_.position_of(j.node)), i, j.node});
    }
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), later());
      const Entry top = heap_.back();
      heap_.pop_back();
      if (done_[top.index]) continue;
      done_[top.index] = true;
      if (settled(top.index, length_[top.index])) return;
      const TileLinks& tile = links_[top.node.tile];
      for (std::uint32_t k = tile.first[top.node.local]; k < tile.first[top.node.local + 1]; ++k) {
        const RoadmapLink& link = tile.links[k];
        const std::uint32_t i = index_of(link.node);
        if (done_[i]) continue;
        const double length = length_[top.index] + link.length_m;
        if (length >= length_[i]) continue;
        length_[i] = length;
        parent_[i] = top.index;
        push({length + (target ? rest(graph_.position_of(link.node)) : 0.0), i, link.node});
      }
    }
  }

  std::uint32_t index_of(const NodeRef& n) const { return base_[n.tile] + n.local; }
  NodeRef node_at(std::uint32_t index) const {
    // The last tile that begins at or before the index contains it: a tile without nodes begins where the
    // next one does.
    const auto tile = std::upper_bound(base_.begin(), base_.end(), index) - base_.begin() - 1;
    return {static_cast<std::uint32_t>(tile), index - base_[static_cast<std::size_t>(tile)]};
  }
  std::size_t size() const { return length_.size(); }
  double length(std::uint32_t index) const { return length_[index]; }
  std::uint32_t parent(std::uint32_t index) const { return parent_[index]; }

 private:
  struct Entry {
    double estimate;
    std::uint32_t index;
    NodeRef node;
  };
  /// The order of the heap, which has the least estimate on top.
  struct Later {
    const GraphSearch* search;
    bool operator()(const Entry& a, const Entry& b) const {
      if (a.estimate != b.estimate) return a.estimate > b.estimate;
      if (search->equal_ == EqualPaths::as_stored) return a.index > b.index;
      return search->graph_.cell_of(a.node) > search->graph_.cell_of(b.node);
    }
  };
  Later later() const { return {this}; }
  void push(const Entry& e) {
    heap_.push_back(e);
    std::push_heap(heap_.begin(), heap_.end(), later());
  }

  const RoadmapGraph& graph_;
  const std::vector<TileLinks>& links_;
  EqualPaths equal_;
  std::vector<std::uint32_t> base_, parent_;
  std::vector<double> length_;
  std::vector<char> done_;
  std::vector<Entry> heap_;
};

}  // namespace

Roadmap::Roadmap(const PlanningOptions& options) : graph_(std::make_unique<RoadmapGraph>(options)) {}
Roadmap::~Roadmap() = default;
Roadmap::Roadmap(Roadmap&&) noexcept = default;
Roadmap& Roadmap::operator=(Roadmap&&) noexcept = default;

void Roadmap::update(const VoxelMap& map, std::span<const CellChange> changes) {
  graph_->update(map, changes);
}

const PlanningOptions& Roadmap::options() const { return graph_->options; }

std::size_t Roadmap::node_count() const {
  std::size_t n = 0;
  for (const RoadmapTile& t : graph_->tiles) n += t.nodes.size();
  return n;
}

bool Roadmap::segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const {
  return graph_->rule && graph_->free.segment_clear(a, b, clearance_m);
}

double Roadmap::clearance_m(const Vec3& p) const {
  return graph_->rule ? graph_->free.nearest(p, kInf).distance_m : 0;
}

double Roadmap::least_clearance_m(std::span<const Vec3> points) const {
  if (!graph_->rule || points.empty()) return 0;
  const FreeTiles& free = graph_->free;
  double least_m = kInf;
  const auto look = [&](const Vec3& p) {
    const double distance_m = clearance_m(p);
    least_m = std::min(least_m, distance_m);
    return distance_m;
  };
  look(points.front());
  const double step_m = 0.25 * free.resolution_m();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 along = points[i] - points[i - 1];
    const double length_m = along.norm();
    // The distance to an obstacle changes by no more than the way flown.
    for (double at_m = step_m; at_m < length_m;) {
      const double distance_m = look(points[i - 1] + along * (at_m / length_m));
      at_m += std::max(step_m, distance_m - least_m);
    }
    look(points[i]);
  }
  return least_m;
}

std::vector<Vec3> Roadmap::places_near(const Vec3& p, double radius_m) const {
  const RoadmapGraph& g = *graph_;
  std::vector<Vec3> out;
  if (!g.rule || !(p.cwiseAbs().maxCoeff() < 1e6) || !(radius_m > 0)) return out;
  const Vec3 radius = Vec3::Constant(radius_m);
  const CellKey low = g.free.key_of(p - radius), high = g.free.key_of(p + radius);
  const auto near = [&](const NodeRef& n) { return (g.position_of(n) - p).norm() <= radius_m; };
  if (blocks_within(radius_m, g.free.resolution_m()) <= static_cast<double>(g.tiles.size())) {
    for (std::int32_t z = low.z & ~3; z <= high.z; z += 4)
      for (std::int32_t y = low.y & ~3; y <= high.y; y += 4)
        for (std::int32_t x = low.x & ~3; x <= high.x; x += 4)
          g.for_each_node_in_block({x, y, z}, [&](const NodeRef& n, const RoadmapNode&) {
            if (near(n)) out.push_back(g.position_of(n));
          });
    return out;
  }
  // The range exceeds all known tiles: visit the existing tiles, in the order of the loops above.
  std::vector<NodeRef> found;
  const TileKey first = tile_of(low), last = tile_of(high);
  for (std::uint32_t i = 0; i < g.tiles.size(); ++i) {
    const TileKey& t = g.table.keys()[i];
    if (t.x < first.x || t.y < first.y || t.z < first.z || t.x > last.x || t.y > last.y || t.z > last.z)
      continue;
    for (std::uint32_t n = 0; n < g.tiles[i].nodes.size(); ++n)
      if (near({i, n})) found.push_back({i, n});
  }
  const auto block = [&g](const NodeRef& n) {
    const CellKey& k = g.cell_of(n);
    return std::array{k.z >> 2, k.y >> 2, k.x >> 2};
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const NodeRef& a, const NodeRef& b) { return block(a) < block(b); });
  for (const NodeRef& n : found) out.push_back(g.position_of(n));
  return out;
}

std::optional<Vec3> Roadmap::approach(const VoxelMap& map, const Vec3& goal, double tolerance_m,
                                      WorkBudget* work) const {
  const RoadmapGraph& g = *graph_;
  if (!g.rule) return std::nullopt;
  if (g.free.is_clear(goal, g.clearance_m)) return goal;
  if (map.at(goal) != Cell::free) return std::nullopt;  // no place sees it through free cells
  struct Candidate {
    Vec3 position;
    double away_m;
  };
  // Shell by shell, nearest first: a suitable place is mostly near.
  double beyond_m = -1;
  for (double radius_m = std::min(kFirstShell_m, tolerance_m);;
       radius_m = std::min(2 * radius_m, tolerance_m)) {
    std::vector<Candidate> shell;
    for (const Vec3& p : places_near(goal, radius_m))
      if (const double away_m = (p - goal).norm(); away_m > beyond_m) shell.push_back({p, away_m});
    std::stable_sort(shell.begin(), shell.end(),
                     [](const Candidate& a, const Candidate& b) { return a.away_m < b.away_m; });
    const double looked_at = std::min(blocks_within(radius_m, g.free.resolution_m()),
                                      static_cast<double>(g.tiles.size() + node_count()));
    if (work && !work->spend(static_cast<std::uint64_t>(looked_at))) return std::nullopt;
    for (const Candidate& place : shell) {
      const double cells = 1 + 2 * place.away_m / g.free.resolution_m();  // approximate length of the line
      if (work && !work->spend(static_cast<std::uint64_t>(cells))) return std::nullopt;
      if (!map.first_not_free(place.position, goal)) return place.position;
    }
    if (!(radius_m < tolerance_m)) return std::nullopt;
    beyond_m = radius_m;
  }
}

std::vector<double> Roadmap::distances(const VoxelMap& map, const Vec3& from, std::span<const Vec3> goals,
                                       double goal_tolerance_m, double max_m, WorkBudget* work) const {
  const RoadmapGraph& g = *graph_;
  std::vector<double> out(goals.size(), kInf);
  if (!g.rule) return out;
  const std::vector<Vec3> escape = path_to_clear(map, g, from);
  if (escape.empty()) return out;
  const Vec3& start = escape.back();
  const double escape_m = path_length_m(escape);

  GraphSearch search(g);
  std::vector<std::vector<Join>> goal_joins(goals.size());
  std::vector<std::uint32_t> wanted;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const std::optional<Vec3> goal = approach(map, goals[i], goal_tolerance_m, work);
    if (work && work->exhausted()) return out;
    if (!goal) continue;
    const double straight = (*goal - start).norm();
    if (straight <= kDirect_m && g.free.segment_clear(start, *goal, g.clearance_m)) {
      out[i] = escape_m + straight;
      continue;
    }
    goal_joins[i] = g.kept_joins(*goal);
    for (const Join& j : goal_joins[i]) wanted.push_back(search.index_of(j.node));
  }
  std::vector<char> is_wanted(search.size(), false);
  std::size_t left = 0;
  for (const std::uint32_t node : wanted) {
    left += !is_wanted[node];
    is_wanted[node] = true;
  }
  if (left > 0)
    search.run(g.joins(start), std::nullopt, [&](std::uint32_t node, double length_m) {
      return length_m > max_m || (is_wanted[node] && --left == 0);
    });
  for (std::size_t i = 0; i < goals.size(); ++i)
    for (const Join& j : goal_joins[i])
      if (const double length_m = search.length(search.index_of(j.node)); length_m <= max_m)
        out[i] = std::min(out[i], escape_m + length_m + j.length_m);
  return out;
}

Path Roadmap::find(const VoxelMap& map, const Vec3& from, const Vec3& goal, EqualPaths equal) const {
  const RoadmapGraph& g = *graph_;
  Path path;
  const auto fail = [&path](PlanStatus status, const char* reason) {
    path = Path{};
    path.status = status;
    path.reason = reason;
    return path;
  };
  if (!g.rule) return fail(PlanStatus::no_path, "the roadmap is empty");
  if (!g.free.is_clear(goal, g.clearance_m))
    return fail(PlanStatus::goal_blocked, "the goal is nearer to an obstacle than the clearance");
  path.points = path_to_clear(map, g, from);
  if (path.points.empty())
    return fail(PlanStatus::start_blocked,
                "the start is nearer to an obstacle than the clearance and no way leads out");
  path.escape_points = path.points.size() - 1;
  const Vec3 start = path.points.back();

  GraphSearch search(g, equal);
  const std::vector<Join> outs = g.joins(start), ins = g.joins(goal);
  const Join* in = nullptr;
  double best = kInf;
  search.run(outs, goal, [&](std::uint32_t node, double length) {
    for (const Join& j : ins)
      if (search.index_of(j.node) == node && length + j.length_m < best) {
        best = length + j.length_m;
        in = &j;
      }
    // No later node can lead to a path shorter than the smallest estimate settled so far.
    return length + (g.position_of(search.node_at(node)) - goal).norm() >= best;
  });
  if (in == nullptr) return fail(PlanStatus::no_path, "no way through known free space leads to the goal");

  std::vector<NodeRef> nodes;
  for (std::uint32_t i = search.index_of(in->node); i != kNone; i = search.parent(i))
    nodes.push_back(search.node_at(i));
  std::reverse(nodes.begin(), nodes.end());
  for (const Join& j : outs)
    if (search.index_of(j.node) == search.index_of(nodes.front()))
      append_path(g, j, nodes, *in, goal, path.points);
  path.status = PlanStatus::found;
  measure(path, kInf);
  return path;
}

}  // namespace karst::core
