// Viewpoints all over the space that can be flown through, and the shortest paths between them.
#pragma once
#include <vector>

#include "sdk/evaluation/reachable/reachable.h"
#include "tests/benchmark/offline_bound/tour_search.h"

namespace karst::bound {

struct ViewGraph {
  std::vector<core::Vec3> places;  // [0] is the start
  std::size_t left_out = 0;        // viewpoints that no straight steps join with the start
  double flyable_near = 0;         // share of the flyable cells that a place is within 1.5 `spacing_m` of
  std::vector<std::vector<Place>> near;
  std::vector<float> distance_m;  // as in TourProblem
  std::vector<Place> toward;
};

/// One viewpoint in each cube of `spacing_m` that holds flyable cells: that nearest to its middle. Places are
/// joined if the segment between them stays in flyable cells and their cubes are at most two apart in each
/// axis. Where that leaves eight places or more alone, as behind a narrow passage, places along the cells of
/// a way there are added. Paths on this graph are a few per cent longer than the shortest. Throws InputError
/// if there are more than 65535.
ViewGraph view_graph(const evaluation::Reachable& r, const core::Vec3& start, double spacing_m);

/// A way on the graph with its corners cut where flyable cells allow; it still passes each of `targets` in
/// order.
std::vector<core::Vec3> pulled_taut(const evaluation::Reachable& r, const ViewGraph& g,
                                    const std::vector<Place>& way, const std::vector<Place>& targets);

}  // namespace karst::bound
