#include "sdk/host/services/passage_question.h"

#include "sdk/host/services/snapshot.h"

namespace karst::host {

const core::PassageMap* PassageQuestion::answer(const core::VoxelMap& map, const core::Vec3& start) {
  const std::lock_guard lock(mutex_);
  if (!asked_) {
    core::WorkBudget work(core::kMaxPassageWork);
    found_ = core::find_passages(map, start, work);
    asked_ = true;
  }
  return found_ ? &*found_ : nullptr;
}

karst_passage_t to_abi(const core::Passage& p) {
  karst_passage_t out{};
  out.ends[0] = p.ends[0];
  out.ends[1] = p.ends[1];
  out.length_m = p.length_m;
  out.mean_width_m = p.mean_width_m;
  out.least_width_m = p.least_width_m;
  out.mean_height_m = p.mean_height_m;
  out.least_height_m = p.least_height_m;
  out.volume_m3 = p.volume_m3;
  out.frontier_m2 = p.frontier_m2;
  out.middle = to_abi(p.middle);
  return out;
}

karst_passage_end_t to_abi(const core::PassageEnd& e) {
  karst_passage_end_t out{};
  out.position = to_abi(e.position);
  out.from_start_m = e.from_start_m;
  out.width_m = e.width_m;
  out.height_m = e.height_m;
  out.volume_m3 = e.volume_m3;
  out.frontier_m2 = e.frontier_m2;
  out.kind = static_cast<karst_passage_end_kind_t>(e.kind);
  out.ways = e.ways;
  return out;
}

karst_passage_place_t to_abi(const core::PassagePlace& p) {
  return {p.passage, p.end, p.from_start_m, p.width_m, p.height_m};
}

static_assert(static_cast<std::uint32_t>(core::PassageEnd::Kind::junction) == KARST_PASSAGE_JUNCTION);
static_assert(static_cast<std::uint32_t>(core::PassageEnd::Kind::dead_end) == KARST_PASSAGE_DEAD_END);
static_assert(static_cast<std::uint32_t>(core::PassageEnd::Kind::open_end) == KARST_PASSAGE_OPEN_END);
static_assert(static_cast<std::uint32_t>(core::PassageEnd::Kind::ring) == KARST_PASSAGE_RING);
static_assert(core::kNoPassage == KARST_NO_PASSAGE);

}  // namespace karst::host
