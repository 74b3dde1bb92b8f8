// The map as octomap::OcTree: the blocks in Morton order are the tree's leaves from left to right, so that
// every node is created, updated and pruned once.
#include <octomap/octomap.h>

#include <span>

#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/mapping/octomap/octomap_io.h"

namespace karst::core {
namespace {

using octomap::OcTree;
using octomap::OcTreeNode;

constexpr int kBlockDepthBits = 13;  // of OctoMap's 16 levels, the number above the blocks

/// The block's position in the tree: three bits per level, OctoMap's child index (x lowest).
std::uint64_t morton_of(BlockId id) {
  const CellKey corner = corner_of(id);
  const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + kWorldCells) >> 3; };
  std::uint64_t code = 0;
  for (int level = 0; level < kBlockDepthBits; ++level) {
    const auto bit = [&](std::int32_t v) { return part(v) >> level & 1; };
    code |= (bit(corner.x) | bit(corner.y) << 1 | bit(corner.z) << 2) << (3 * level);
  }
  return code;
}

struct Leaf {
  std::uint64_t morton;
  const Block* block;
};

OcTreeNode* child_of(OcTree& tree, OcTreeNode* node, unsigned i) {
  return tree.nodeChildExists(node, i) ? tree.getNodeChild(node, i) : tree.createNodeChild(node, i);
}

void finish(OcTree& tree, OcTreeNode* node) {
  if (!tree.pruneNode(node)) node->updateOccupancyChildren();
}

/// Cells of a block: the cube of edge 1 << bits at (x, y, z).
struct Cube {
  std::uint32_t x = 0, y = 0, z = 0;
  int bits = 3;
};

/// True if some cell of the cube is known.
bool any_known(const Block& b, const Cube& c) {
  const std::uint32_t edge = 1u << c.bits;
  for (std::uint32_t k = c.z; k < c.z + edge; ++k)
    for (std::uint32_t j = c.y; j < c.y + edge; ++j)
      for (std::uint32_t i = c.x; i < c.x + edge; ++i)
        if (b.log_odds[i | j << 3 | k << 6] != kUnknown) return true;
  return false;
}

void build_in_block(OcTree& tree, OcTreeNode* node, const Block& b, const Cube& c) {
  if (c.bits == 0) {
    node->setLogOdds(static_cast<float>(b.log_odds[c.x | c.y << 3 | c.z << 6]) / kLogOddsScale);
    return;
  }
  const std::uint32_t half = 1u << (c.bits - 1);
  for (unsigned i = 0; i < 8; ++i) {
    const Cube octant{c.x + (i & 1 ? half : 0), c.y + (i & 2 ? half : 0), c.z + (i & 4 ? half : 0),
                      c.bits - 1};
    if (any_known(b, octant)) build_in_block(tree, child_of(tree, node, i), b, octant);
  }
  finish(tree, node);
}

/// `leaves` are all blocks below `node`, which is `levels` levels above them.
void build(OcTree& tree, OcTreeNode* node, std::span<const Leaf> leaves, int levels) {
  if (levels == 0) {
    build_in_block(tree, node, *leaves.front().block, Cube{});
    return;
  }
  for (std::size_t begin = 0, end = 0; begin < leaves.size(); begin = end) {
    const auto child = [&](const Leaf& l) {
      return static_cast<unsigned>(l.morton >> (3 * (levels - 1)) & 7);
    };
    const unsigned i = child(leaves[begin]);
    while (end < leaves.size() && child(leaves[end]) == i) ++end;
    build(tree, child_of(tree, node, i), leaves.subspan(begin, end - begin), levels - 1);
  }
  finish(tree, node);
}

}  // namespace

std::unique_ptr<OcTree> to_octree(const VoxelMap& map) {
  auto tree = std::make_unique<OcTree>(map.resolution_m());
  std::vector<Leaf> leaves;
  for (const auto& b : VoxelReader(map).blocks().all())
    if (any_known(*b, Cube{})) leaves.push_back({morton_of(b->id), b.get()});
  if (leaves.empty()) return tree;
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.morton < b.morton; });

  // OctoMap's public interface creates a root only by setting a cell; that cell gets its own value below.
  const Block& first = *leaves.front().block;
  std::uint32_t i = 0;
  while (first.log_odds[i] == kUnknown) ++i;
  const CellKey k = cell_in(corner_of(first.id), i);
  const auto part = [](std::int32_t v) { return static_cast<octomap::key_type>(v + kWorldCells); };
  tree->setNodeValue(octomap::OcTreeKey(part(k.x), part(k.y), part(k.z)), 0.0f, true);
  build(*tree, tree->getRoot(), leaves, kBlockDepthBits);
  return tree;
}

}  // namespace karst::core
