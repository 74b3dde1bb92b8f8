// A planning query in OMPL's terms, with the same state space, validity check and sampling for every planner.
// Private to planning: only two .cpp files include OMPL's headers.
#pragma once
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include "core_stack/planning/free_space/block_bits.h"
#include "core_stack/planning/free_space/free_tiles.h"

namespace karst::core {

inline Vec3 point_of(const ompl::base::State* s) {
  const double* v = s->as<ompl::base::RealVectorStateSpace::StateType>()->values;
  return {v[0], v[1], v[2]};
}
inline void set_point(ompl::base::State* s, const Vec3& p) {
  double* v = s->as<ompl::base::RealVectorStateSpace::StateType>()->values;
  v[0] = p.x();
  v[1] = p.y();
  v[2] = p.z();
}

/// The cells that states are sampled from: a cave fills so little of its bounding box that samples from the
/// box would nearly always hit rock.
struct SampledCells {
  struct Block {
    CellKey corner;
    BlockBits cells;
  };
  std::vector<Block> blocks;
  std::vector<std::uint64_t> up_to;  // cumulative number of cells, each block included
};

struct OmplQuery {
  Vec3 low, high;  // of the box that is searched
  Vec3 start, goal;
  double clearance_m;
};

/// A query as all planners are asked it. `free` must live as long as this.
struct OmplProblem {
  ompl::base::SpaceInformationPtr space;
  ompl::base::ProblemDefinitionPtr definition;
};

/// R^3 within the box; a state is valid if it is clear, and a motion if every point of it is.
OmplProblem make_problem(const FreeTiles& free, const std::shared_ptr<const SampledCells>& cells,
                         const OmplQuery& query);

}  // namespace karst::core
