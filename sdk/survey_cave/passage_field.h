// The cave as a signed distance field, negative in free space: the union of its passages, with rough walls.
#pragma once
#include <cstdint>
#include <vector>

#include "plugins/simulator/cave_generator/samples.h"
#include "sdk/survey_cave/tube.h"

namespace karst::survey_cave {

struct FieldOptions {
  double grid_m = 0.25;
  double roughness_m = 0.1;  // greatest displacement of the walls
  std::uint32_t noise_seed = 0;
};

/// Where passages meet, the edge between them is rounded. Roughness displaces space by a smooth random vector
/// that is never longer than `roughness_m`: no wall moves farther, and passages stay connected. Its waves are
/// 2 m and 0.8 m long, and never shorter than three steps of the grid, which could not show them.
class PassageField {
 public:
  /// The tubes by passage; they must outlive the field.
  PassageField(const std::vector<Tube>& tubes, const FieldOptions& options);

  std::size_t block_count() const { return corners_.size(); }
  /// Values at the nodes of the blocks near a passage. Throws std::length_error as Samples does.
  cave::Samples sampled() const;

 private:
  using TubeList = std::vector<std::uint32_t>;
  void fill(std::size_t block, const core::Vec3& corner, float* values) const;
  void fill_part(const TubeList& near, const core::Vec3& corner, const cave::Node& first, int edge,
                 float* values) const;
  double value(const core::Vec3& place, const TubeList& near) const;
  core::Vec3 displacement(const core::Vec3& p) const;

  const std::vector<Tube>& tubes_;
  FieldOptions options_;
  double join_m_;  // width of the rounded edge
  core::Vec3 low_ = core::Vec3::Zero();
  std::vector<cave::Node> corners_;        // of the blocks, ascending by z, y, x
  std::vector<std::uint32_t> first_tube_;  // by block, and one more: range in block_tubes_
  std::vector<std::uint32_t> block_tubes_;
};

}  // namespace karst::survey_cave
