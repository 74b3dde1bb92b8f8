// The graph of slices without what only shows that rock is rough. Slices are merged until every branch is
// longer than it is wide (simplification by persistence: Pascucci, Scorzelli, Bremer and Mascarenhas, Robust
// on-line computation of Reeb graphs, 2007).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/planning/passages/cross_section.h"
#include "core_stack/planning/passages/slices.h"

namespace karst::core {

constexpr std::uint32_t kNoGroup = ~std::uint32_t{0};

/// Slices that count as one place.
struct SliceGroup {
  std::vector<std::uint32_t> slices;  // sorted
  std::vector<std::uint32_t> next;    // groups joined to it, sorted
  std::uint32_t core = 0;             // the slice that shows its position and width
};

/// Groups in a row, none of them a junction: a group with three or more neighbours.
struct SliceChain {
  std::vector<std::uint32_t> groups;  // from the first end to the last; none between junctions that touch
  std::array<std::uint32_t, 2> junctions{kNoGroup, kNoGroup};  // at either end; kNoGroup: it ends there
  bool is_ring = false;                                        // its last group is joined to its first
};

/// All chains, each once.
std::vector<SliceChain> chains_of(const std::vector<SliceGroup>& groups);

/// Merges slices into groups until no chain is left that is short:
/// - one that ends somewhere, if no piece of it at that end is longer than it is wide; it becomes part of its
///   junction;
/// - one that leads from a junction to a junction, if it is shorter than its mean width, or than one of them
///   is wide; both and the chain become one group. The same for one that leads back to where it began, if it
///   is shorter than twice that.
/// Up to two bands everything is short. `sections`: one for each slice; lengths are measured along their
/// centres.
/// Then the core of each junction is its widest slice, and the groups beside it whose core is within half of
/// that width of it are merged into it: a hall is one junction, and not part of the passages that lead there.
std::vector<SliceGroup> simplified(const std::vector<Slice>& slices,
                                   const std::vector<CrossSection>& sections, double band_m);

/// Whether a passage leads on into the unknown at the end whose last groups these are: the frontier there is
/// a quarter of the passage's cross-section or more.
bool is_open_end(std::span<const std::uint32_t> last, const std::vector<SliceGroup>& groups,
                 const std::vector<Slice>& slices, const PassageGrid& grid);

}  // namespace karst::core
