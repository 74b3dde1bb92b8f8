// The passages of a cave as a graph: the level sets of the distance from one end, divided into connected
// components (the Reeb graph of that distance; Lazarus and Verroust, Level set diagrams, 1999). A component
// is a node: a slice of passage. Components that touch are joined by an edge, always between consecutive
// bands of distance.
//
// Rock is rough, so the graph is simplified by persistence (Pascucci, Scorzelli, Bremer, Mascarenhas, 2007):
// a loop around a pillar is closed if it is shorter, in bands, than the passages are wide, and dead ends as
// short are removed.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sdk/selection/cell_index.h"

namespace karst::selection {

struct PassageNode {
  int band = 0;
  std::vector<std::int32_t> cells;  // indices of the cells
  std::vector<int> below, above;    // nodes of the bands before and after, sorted
};

/// Ordered by band. Every cell must have a finite distance, and bands must be thicker than a cell's
/// diagonal.
std::vector<PassageNode> passage_nodes(const CellIndex& cells, const std::vector<float>& distance,
                                       float band);

/// Merges the nodes of each band in loops that take fewer than `least` bands from where their branches part
/// to where they meet.
std::vector<PassageNode> without_short_loops(const std::vector<PassageNode>& nodes, int least);
/// Removes dead ends of fewer than `least` nodes, the shortest first; a path from one end to the other is
/// kept.
std::vector<PassageNode> without_short_ends(const std::vector<PassageNode>& nodes, int least);

/// Where more than two ways meet: their number less two, summed; a crossing of four counts as two junctions.
int junctions(std::span<const PassageNode> nodes);
/// Places where a passage ends.
int dead_ends(std::span<const PassageNode> nodes);
/// Number of independent loops: edges - nodes + 1 of a connected graph.
int loops(std::span<const PassageNode> nodes);

}  // namespace karst::selection
