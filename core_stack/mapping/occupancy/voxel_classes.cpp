#include "core_stack/mapping/occupancy/voxel_classes.h"

#include "core_stack/mapping/occupancy/voxel_reader.h"

namespace karst::core {
namespace {

ClassBlock classes_of(const Block& b) {
  ClassBlock out;
  out.low = corner_of(b.id);
  for (std::size_t i = 0; i < out.classes.size(); ++i) {
    unsigned four = 0;
    for (unsigned j = 0; j < 4; ++j)
      four |= static_cast<unsigned>(class_of(b.log_odds[4 * i + j])) << (2 * j);
    out.classes[i] = static_cast<std::uint8_t>(four);
  }
  return out;
}

}  // namespace

bool is_sound(const ClassBlock& block) {
  if (((block.low.x | block.low.y | block.low.z) & (kBlockEdge - 1)) != 0 || !in_world(block.low))
    return false;
  return std::none_of(block.classes.begin(), block.classes.end(),
                      [](std::uint8_t four) { return (four & four >> 1 & 0x55) != 0; });
}

std::vector<ClassBlock> blocks_changed_after(const VoxelMap& map, std::uint64_t since) {
  std::vector<const Block*> changed;
  for (const auto& b : VoxelReader(map).blocks().all())
    if (b->revision > since) changed.push_back(b.get());
  std::sort(changed.begin(), changed.end(), [](const Block* a, const Block* b) { return a->id < b->id; });
  std::vector<ClassBlock> out;
  out.reserve(changed.size());
  for (const Block* b : changed) out.push_back(classes_of(*b));
  return out;
}

std::vector<CellChange> assign_blocks(VoxelMap& map, std::span<const ClassBlock> blocks,
                                      std::uint64_t revision) {
  constexpr std::array<std::int16_t, 3> values = {kUnknown, -static_cast<std::int16_t>(kLogOddsScale),
                                                  static_cast<std::int16_t>(kLogOddsScale)};
  auto& s = VoxelReader::storage_of(map);
  s.revision = revision;
  std::vector<CellChange> changes;
  for (const ClassBlock& from : blocks) {
    Block& b = s.blocks.find_or_add(block_of(from.low));
    for (std::uint32_t i = 0; i < b.log_odds.size(); ++i) {
      const auto c = static_cast<std::size_t>(from.classes[i / 4] >> (2 * (i % 4)) & 3);
      if (class_of(b.log_odds[i]) != static_cast<Cell>(c)) s.set(b, from.low, i, values[c], changes);
    }
  }
  sort_by_key(changes);
  return changes;
}

}  // namespace karst::core
