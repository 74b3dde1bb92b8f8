// The homing tree (Algorithm 1 of the paper): from every place where robots were, the quickest known way to
// the nearest communication node.
//
// Pose nodes are past poses of any robot, communication nodes the base, landed robots and dropped nodes. Two
// nodes no farther apart than the longest edge are joined if a vehicle can fly the straight line between them
// (a free ray). Every node knows the least flight time over free rays to a living communication node
// (ShortestPaths). docs/homing.md says where this goes beyond the paper, and why.
//
// The tree is a function of the set of facts that went into it (tree_facts.h): robots that hold the same
// facts hold the same tree to the last bit, whatever the order in which they heard them.
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

/// Whether a vehicle can fly the straight line between two points. Asked with the node of the lesser id
/// first.
using FreeRay = std::function<bool(const Vec3& from, const Vec3& to)>;

struct HomingTreeOptions {
  double min_edge_m = 2.0;       // d_e: a pose nearer than that to any node adds none
  double longest_edge_m = 15.0;  // rays are looked at up to this length
  std::int64_t max_nodes = 20000;
};
void describe(OptionTable& t, HomingTreeOptions& o);

struct HomingRoute {
  std::vector<Vec3> points;   // from where it was asked for to the communication node
  std::vector<NodeId> nodes;  // behind the first point
  double length_m = 0;
  double time_s = 0;  // at the cruise speed; ramps come on top once a flight: flight_time_s(length_m)
};

class HomingTree {
 public:
  /// An edge's cost is its length over `cruise_mps`: what adds up along a way. Starting and stopping do not,
  /// and are the same for every way.
  HomingTree(const HomingTreeOptions& options, double cruise_mps);

  /// Algorithm 1 for a pose. Returns the facts to share; none, and no node, if the pose is nearer than the
  /// least edge to a node or there is no room for more. A ray is asked for to every node within reach.
  TreeFacts insert_pose(const NodeId& id, const Vec3& position, TimeNs stamp, const FreeRay& free_ray);
  /// Algorithm 1 for a communication node, wherever it is.
  TreeFacts insert_communication(const NodeId& id, const Vec3& position, TimeNs stamp,
                                 const FreeRay& free_ray);
  TreeFacts set_alive(const NodeId& id, bool alive, TimeNs stamp);
  /// Asks for the rays of a node that nobody has said anything of: for nodes that others told of.
  TreeFacts look_from(const NodeId& id, TimeNs stamp, const FreeRay& free_ray);
  /// The map changed within the box: asks again for every ray that passes within `margin_m` of it. A ray that
  /// is known to be free is taken back only if `rock` says that the map shows rock in it: what is unknown
  /// here another robot may have seen through. The facts are what changed by it.
  TreeFacts recheck(const Vec3& low, const Vec3& high, double margin_m, TimeNs stamp, const FreeRay& free_ray,
                    const FreeRay& rock);

  /// Takes in what others told. Returns how many facts had to be refused: positions that are not finite,
  /// nodes beyond max_nodes, rays to themselves or beyond what a node can have.
  std::size_t apply(const TreeFacts& facts);
  /// All it holds, sorted by id.
  TreeFacts facts() const;

  /// The quickest way from a place, its first ray asked for in the map; nothing if there is none.
  std::optional<HomingRoute> route(const Vec3& from, const FreeRay& free_ray) const;
  /// Flight time from a node to its communication node; unreachable (infinity) without a way.
  double cost_s(const NodeId& id) const;
  /// The next node on that way; nothing for a living communication node or without a way.
  std::optional<NodeId> next(const NodeId& id) const;

  std::vector<TreeNode> nodes() const;  // sorted by id
  bool alive(const NodeId& id) const;   // a living communication node
  std::size_t node_count() const { return known_; }

 private:
  struct Ray {
    std::uint32_t to;
    bool free;
    TimeNs stamp;
  };
  /// A node that was only named, by a ray that came before it, has no place yet and takes no part.
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
