// The passages of a policy's map: found when they are first asked for, and kept as long as the map.
#pragma once
#include <mutex>
#include <optional>

#include "core_stack/planning/passages/passages.h"
#include "sdk/abi/karst_abi_services.h"

namespace karst::host {

class PassageQuestion {
 public:
  /// The passages of `map` connected to `start`, or null if that is more than core::kMaxPassageWork. Every
  /// question must be about the same cells and the same start. Several threads may ask: one finds the answer,
  /// the others wait for it.
  const core::PassageMap* answer(const core::VoxelMap& map, const core::Vec3& start);

 private:
  std::mutex mutex_;
  bool asked_ = false;
  std::optional<core::PassageMap> found_;
};

karst_passage_t to_abi(const core::Passage& passage);
karst_passage_end_t to_abi(const core::PassageEnd& end);
karst_passage_place_t to_abi(const core::PassagePlace& place);

}  // namespace karst::host
