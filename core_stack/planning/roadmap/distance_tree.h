// Distances over the roadmap from everywhere to one place, and the ways there, kept up to date as the roadmap
// changes: asking takes microseconds however far the place is.
//
// Every node knows the length of its shortest way to the root. When nodes vanish, those whose way led through
// them forget theirs; they and the new nodes then take the best that their neighbours offer, and what gets
// shorter is passed on, shortest first (after Ramalingam and Reps, 1996). So an update costs as much as there
// are nodes whose distance changes: few at the edge of the explored, all that lies behind a rockfall. The
// lengths are the same as if computed from scratch, to the last bit.
#pragma once
#include <memory>
#include <optional>

#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::core {

class DistanceTree {
 public:
  DistanceTree();
  ~DistanceTree();
  DistanceTree(DistanceTree&&) noexcept;
  DistanceTree& operator=(DistanceTree&&) noexcept;

  /// To be called after each update of the roadmap, always the same one, before anything is asked. A root
  /// that is not clear by the search's clearance has no distances; a root that moves costs a computation from
  /// scratch.
  void update(const Roadmap& roadmap, const Vec3& root);

  /// Length in metres of the shortest way from `from` to the root on the roadmap, an escape from a tight
  /// place included; nothing if there is none.
  std::optional<double> length_m(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;
  /// That way, of the search's clearance; raw: pass it to refine_path. It depends on the map only, not on how
  /// the map came about.
  Path find(const VoxelMap& map, const Roadmap& roadmap, const Vec3& from) const;

  /// Nodes whose distance the last update looked at: what it cost.
  std::size_t touched() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace karst::core
