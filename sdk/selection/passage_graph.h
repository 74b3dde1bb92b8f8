// The passages of a cave as a graph: the level sets of the distance from one of its ends, cut into their
// connected parts (the Reeb graph of that distance; Lazarus and Verroust, Level set diagrams, 1999). A part
// is a node: a slice of passage; parts that touch are joined by an edge, always from one band of distances to
// the next.
//
// Rock is rough, so the graph is simplified by persistence (Pascucci, Scorzelli, Bremer, Mascarenhas, 2007):
// a way round a pillar that is shorter, in bands, than the passages are wide is closed, and so shallow a dead
// end is taken off.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sdk/selection/cell_index.h"

namespace karst::selection {

struct PassageNode {
  int band = 0;
  std::vector<std::int32_t> cells;  // of the index
  std::vector<int> below, above;    // nodes of the bands before and after, sorted
};

/// In the order of bands. Every cell must have a finite distance, and bands be thicker than a cell's
/// diagonal.
std::vector<PassageNode> passage_nodes(const CellIndex& cells, const std::vector<float>& distance,
                                       float band);

/// Unites the nodes of each band round loops of fewer than `least` bands from where their ways part to where
/// they meet.
std::vector<PassageNode> without_short_loops(const std::vector<PassageNode>& nodes, int least);
/// Takes dead ends of fewer than `least` nodes off, the shortest first; a way from one end to the other
/// stays.
std::vector<PassageNode> without_short_ends(const std::vector<PassageNode>& nodes, int least);

/// Where more than two ways meet: their number less two, summed; a crossing of four counts as two junctions.
int junctions(std::span<const PassageNode> nodes);
/// Independent ways round: edges - nodes + 1 of a connected graph.
int loops(std::span<const PassageNode> nodes);

}  // namespace karst::selection
