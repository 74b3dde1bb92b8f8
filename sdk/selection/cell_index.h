// Consecutive numbers for the cells of a set, in the set's order, so that data per cell can be kept in a
// plain vector.
#pragma once
#include <bit>

#include "sdk/evaluation/reachable/cell_set.h"

namespace karst::selection {

class CellIndex {
 public:
  explicit CellIndex(const evaluation::CellSet& cells) : cells_(cells) {
    first_.assign(cells.block_count(), -1);
    cells.for_each([this](const core::CellKey& k) {
      std::int32_t& first = first_[static_cast<std::size_t>(cells_.number_of(cells_.block_of(k)))];
      if (first < 0) first = static_cast<std::int32_t>(keys_.size());
      keys_.push_back(k);
    });
  }

  std::size_t size() const { return keys_.size(); }
  const core::CellKey& key(std::size_t i) const { return keys_[i]; }

  /// -1 if the set does not contain the cell.
  std::int32_t at(const core::CellKey& k) const {
    const std::int32_t number = cells_.number_of(cells_.block_of(k));
    if (number < 0) return -1;
    const evaluation::CellSet::Block& block = cells_.block(number);
    const int z = k.z & 7, bit = (k.y & 7) * 8 + (k.x & 7);
    const std::uint64_t slice = block[static_cast<std::size_t>(z)];
    if ((slice >> bit & 1u) == 0) return -1;
    int before = std::popcount(slice & ((std::uint64_t{1} << bit) - 1));
    for (int i = 0; i < z; ++i) before += std::popcount(block[static_cast<std::size_t>(i)]);
    return first_[static_cast<std::size_t>(number)] + before;
  }

 private:
  const evaluation::CellSet& cells_;
  std::vector<std::int32_t> first_;  // of each block, by CellSet::number_of
  std::vector<core::CellKey> keys_;
};

}  // namespace karst::selection
