// The passages of the cave as far as it is mapped, where they meet and where they end: a graph, found from
// the map alone. How it is found: free_parts.h, slices.h, cross_section.h, slice_graph.h.
//
// Volumes are those of free cells. The frontier is measured as its free cells times a cell's face.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core_stack/planning/passages/free_parts.h"

namespace karst::core {

constexpr std::uint32_t kNoPassage = ~std::uint32_t{0};

/// A place where passages meet, or one ends.
struct PassageEnd {
  enum class Kind : std::uint32_t {
    junction = 1,  // three or more ends of passages meet
    dead_end = 2,  // one passage ends at rock
    open_end = 3,  // one passage leads on into unknown space
    ring = 4       // one passage without a junction comes back to where it began
  };
  Vec3 position = Vec3::Zero();
  double from_start_m = 0;  // along the passages
  double width_m = 0, height_m = 0;
  // Of a junction; of another end, that of the last two slices of its passage.
  double volume_m3 = 0, frontier_m2 = 0;
  std::uint32_t ways = 0;  // ends of passages
  Kind kind = Kind::junction;
};

struct Passage {
  std::array<std::uint32_t, 2> ends{};  // indices; first the one nearer to the start
  double length_m = 0;                  // from end to end, along its middle
  double mean_width_m = 0, least_width_m = 0, mean_height_m = 0, least_height_m = 0;
  double volume_m3 = 0, frontier_m2 = 0;  // without the junctions
  Vec3 middle = Vec3::Zero();             // on its middle line, half way
};

/// What is around a point. One of the indices is kNoPassage; both, if the point is not in the space.
struct PassagePlace {
  std::uint32_t passage = kNoPassage, end = kNoPassage;  // `end`: a junction
  double from_start_m = 0, width_m = 0, height_m = 0;
};

class PassageMap {
 public:
  /// Both by distance from the start.
  std::vector<Passage> passages;
  std::vector<PassageEnd> ends;

  /// Around the part of the space nearest to `p`, at most about two cubes' edges from it.
  PassagePlace at(const Vec3& p) const;

 private:
  friend class PassageMapBuilder;
  FreeParts space_;
  std::vector<std::uint32_t> slice_of_;  // each part
  std::vector<PassagePlace> places_;     // each slice
};

/// The passages connected to `start`; none if no free space is near it. nullopt once `work` is exhausted.
/// The same for equal classes of cells, whatever the order in which they became known.
std::optional<PassageMap> find_passages(const VoxelMap& map, const Vec3& start, WorkBudget& work);

}  // namespace karst::core
