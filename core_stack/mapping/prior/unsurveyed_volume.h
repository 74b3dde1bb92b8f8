// The volume that a map knows to be free and a survey does not have.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/prior/surveyed_passages.h"

namespace karst::core {

/// Counts the free cells whose centres are more than kBeyondSurvey_m from the surveyed passages, as the map
/// changes.
class UnsurveyedVolume {
 public:
  explicit UnsurveyedVolume(std::shared_ptr<const SurveyedPassages> survey) : survey_(std::move(survey)) {}

  void note(const VoxelMap& map, std::span<const CellChange> changes) {
    for (const CellChange& c : changes) {
      const bool was = c.before == Cell::free, is = c.after == Cell::free;
      if (was == is || survey_->distance_m(map.center_of(c.key)) <= kBeyondSurvey_m) continue;
      cells_ += is ? 1 : -1;
    }
    cell_m3_ = map.resolution_m() * map.resolution_m() * map.resolution_m();
  }
  double m3() const { return static_cast<double>(cells_) * cell_m3_; }

 private:
  std::shared_ptr<const SurveyedPassages> survey_;
  std::int64_t cells_ = 0;
  double cell_m3_ = 0;
};

}  // namespace karst::core
