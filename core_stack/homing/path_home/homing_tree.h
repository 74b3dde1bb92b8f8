// The homing tree (Algorithm 1 of the paper): from every place that robots have visited, the quickest known
// path to the nearest communication node.
//
// Pose nodes are past poses of any robot. Communication nodes are the base, landed robots and dropped nodes.
// Two nodes within the longest edge of each other are joined if a vehicle can fly the straight line between
// them (a free ray). Every node stores its minimal flight time over free rays to a live communication node
// (ShortestPaths). docs/homing.md describes how this extends the paper, and why.
//
// The tree is a function of the set of facts that it has received (tree_facts.h): robots with the same facts
// hold bitwise equal trees, whatever the order in which the facts arrived.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>

#include "core_stack/common/options.h"
#include "core_stack/homing/path_home/place_grid.h"
#include "core_stack/homing/path_home/shortest_paths.h"
#include "core_stack/homing/path_home/tree_facts.h"

namespace karst::core {

/// Whether a vehicle can fly the straight line between two points. It is called with the node of the smaller
/// id first.
using FreeRay = std::function<bool(const Vec3& from, const Vec3& to)>;

struct HomingTreeOptions {
  double min_edge_m = 2.0;       // d_e: a pose nearer than this to a node adds none
  double longest_edge_m = 15.0;  // rays are checked up to this length
  std::int64_t max_nodes = 20000;
};
void describe(OptionTable& t, HomingTreeOptions& o);

struct HomingRoute {
  std::vector<Vec3> points;   // from the start to the communication node
  std::vector<NodeId> nodes;  // those of all points but the first
  double length_m = 0;
  double time_s = 0;  // at cruise speed; flight_time_s(length_m) adds acceleration and braking, once a flight
};

class HomingTree {
 public:
  /// An edge's cost is its length over `cruise_mps`, which adds up along a path. The time to start and stop
  /// does not, but is the same for every path.
  HomingTree(const HomingTreeOptions& options, double cruise_mps);

  /// Algorithm 1 for a pose. Checks the ray to every node within the longest edge and returns the facts to
  /// share. Adds no node and returns no facts if the pose is nearer than the minimal edge to a node or the
  /// tree is full.
  TreeFacts insert_pose(const NodeId& id, const Vec3& position, TimeNs stamp, const FreeRay& free_ray);
  /// Algorithm 1 for a communication node; the minimal edge does not apply.
  TreeFacts insert_communication(const NodeId& id, const Vec3& position, TimeNs stamp,
                                 const FreeRay& free_ray);
  TreeFacts set_alive(const NodeId& id, bool alive, TimeNs stamp);
  /// Checks those rays of a node that no robot has checked: for nodes that others have reported.
  TreeFacts look_from(const NodeId& id, TimeNs stamp, const FreeRay& free_ray);
  /// Rechecks every ray that passes within `margin_m` of a box in which the map has changed. A free ray is
  /// revoked only if `rock` finds occupied cells in it: another robot may have observed cells that are
  /// unknown here. Returns the changed facts.
  TreeFacts recheck(const Vec3& low, const Vec3& high, double margin_m, TimeNs stamp, const FreeRay& free_ray,
                    const FreeRay& rock);

  /// Applies facts reported by others. Returns how many were refused: positions that are not finite, nodes
  /// beyond max_nodes, rays from a node to itself or beyond the number that a node can have.
  std::size_t apply(const TreeFacts& facts);
  /// All facts of the tree, sorted by id.
  TreeFacts facts() const;

  /// The quickest path from a position; its first ray is checked in the map. Nothing if there is none.
  std::optional<HomingRoute> route(const Vec3& from, const FreeRay& free_ray) const;
  /// Flight time from a node to its communication node; unreachable (infinity) without a path.
  double cost_s(const NodeId& id) const;
  /// The next node on that path; nothing for a live communication node or without a path.
  std::optional<NodeId> next(const NodeId& id) const;

  std::vector<TreeNode> nodes() const;  // sorted by id
  bool alive(const NodeId& id) const;   // whether it is a live communication node
  std::size_t node_count() const { return known_; }

 private:
  struct Ray {
    std::uint32_t to;
    bool free;
    TimeNs stamp;
  };
  /// An entry that is not `known` was only named by a ray that arrived before its node: it has no position
  /// yet, and is left out of all paths.
  struct Entry {
    TreeNode node;
    bool known = false, alive = true;
    TimeNs life_stamp = -1;
    std::vector<Ray> rays;
  };

  std::optional<std::uint32_t> find(const NodeId& id) const;
  std::optional<std::uint32_t> find_or_name(const NodeId& id);
  bool place(const TreeNode& node);
  bool set_ray(const RayFact& fact);
  bool set_life(const LifeFact& fact);
  void attach(std::uint32_t i);
  void detach(std::uint32_t i);
  void add_free_rays(std::uint32_t i, TimeNs stamp, const FreeRay& free_ray, TreeFacts& facts);
  bool ask(std::uint32_t i, std::uint32_t k, const FreeRay& free_ray) const;
  const Ray* ray(std::uint32_t i, std::uint32_t k) const;
  double cost_between(std::uint32_t i, std::uint32_t k) const;
  std::vector<std::uint32_t> near(const Vec3& p, double radius_m) const;

  HomingTreeOptions options_;
  double cruise_mps_;
  std::vector<Entry> entries_;  // by index, as in paths_
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
  PlaceGrid grid_;
  ShortestPaths paths_;
  std::size_t known_ = 0;
};

}  // namespace karst::core
