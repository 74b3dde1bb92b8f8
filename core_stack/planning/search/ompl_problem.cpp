#include "core_stack/planning/search/ompl_problem.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/InformedStateSampler.h>

#include <algorithm>
#include <bit>

namespace karst::core {
namespace {

namespace ob = ompl::base;

class ClearState : public ob::StateValidityChecker {
 public:
  ClearState(const ob::SpaceInformationPtr& si, const FreeTiles& free, double clearance_m)
      : ob::StateValidityChecker(si), free_(free), clearance_m_(clearance_m) {}
  bool isValid(const ob::State* s) const override { return free_.is_clear(point_of(s), clearance_m_); }

 private:
  const FreeTiles& free_;
  double clearance_m_;
};

class ClearMotion : public ob::MotionValidator {
 public:
  ClearMotion(const ob::SpaceInformationPtr& si, const FreeTiles& free, double clearance_m)
      : ob::MotionValidator(si), free_(free), clearance_m_(clearance_m) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return free_.segment_clear(point_of(a), point_of(b), clearance_m_);
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(a, b)) return true;
    // If one initial part of a segment is clear, so is every shorter one: bisection finds the longest.
    const Vec3 from = point_of(a), offset = point_of(b) - from;
    double clear = 0, blocked = 1;
    while ((blocked - clear) * offset.norm() > 0.25 * free_.resolution_m()) {
      const double middle = 0.5 * (clear + blocked);
      (free_.segment_clear(from, from + middle * offset, clearance_m_) ? clear : blocked) = middle;
    }
    last_valid.second = clear;
    if (last_valid.first != nullptr) set_point(last_valid.first, from + clear * offset);
    return false;
  }

 private:
  const FreeTiles& free_;
  double clearance_m_;
};

/// Uniform over the cells, and uniform within a cell.
class CellSampler : public ob::StateSampler {
 public:
  CellSampler(const ob::StateSpace* space, std::shared_ptr<const SampledCells> cells, double resolution_m)
      : ob::StateSampler(space), cells_(std::move(cells)), resolution_m_(resolution_m) {}

  void sampleUniform(ob::State* s) override {
    const std::uint64_t total = cells_->up_to.back();
    const auto nth =
        std::min(total - 1, static_cast<std::uint64_t>(rng_.uniform01() * static_cast<double>(total)));
    const auto at = std::upper_bound(cells_->up_to.begin(), cells_->up_to.end(), nth) - cells_->up_to.begin();
    const SampledCells::Block& block = cells_->blocks[static_cast<std::size_t>(at)];
    BlockBits rest = block.cells;
    for (auto skip = nth - (cells_->up_to[static_cast<std::size_t>(at)] -
                            static_cast<std::uint64_t>(std::popcount(block.cells)));
         skip > 0; --skip)
      rest &= rest - 1;
    const int bit = std::countr_zero(rest);
    const CellKey k = block.corner + CellKey{bit & 3, bit >> 2 & 3, bit >> 4};
    const double x = rng_.uniform01(), y = rng_.uniform01(), z = rng_.uniform01();
    set_point(s, Vec3(k.x + x, k.y + y, k.z + z) * resolution_m_);
    space_->enforceBounds(s);
  }
  void sampleUniformNear(ob::State* s, const ob::State* near, double distance) override {
    const double x = rng_.uniformReal(-distance, distance), y = rng_.uniformReal(-distance, distance),
                 z = rng_.uniformReal(-distance, distance);
    set_point(s, point_of(near) + Vec3(x, y, z));
    space_->enforceBounds(s);
  }
  void sampleGaussian(ob::State* s, const ob::State* mean, double deviation) override {
    const double x = rng_.gaussian(0, deviation), y = rng_.gaussian(0, deviation),
                 z = rng_.gaussian(0, deviation);
    set_point(s, point_of(mean) + Vec3(x, y, z));
    space_->enforceBounds(s);
  }

 private:
  std::shared_ptr<const SampledCells> cells_;
  double resolution_m_;
};

/// Samples from the cells until the straight-line distances from the start and to the goal sum to less than
/// the best path.
class InformedCellSampler : public ob::InformedSampler {
 public:
  InformedCellSampler(const ob::ProblemDefinitionPtr& definition, unsigned int max_calls)
      : ob::InformedSampler(definition, max_calls), cells_(space_->allocStateSampler()) {}

  bool sampleUniform(ob::State* s, const ob::Cost& most) override {
    return sampleUniform(s, opt_->identityCost(), most);
  }
  bool sampleUniform(ob::State* s, const ob::Cost& least, const ob::Cost& most) override {
    for (unsigned int i = 0; i < numIters_; ++i) {
      cells_->sampleUniform(s);
      const ob::Cost cost = heuristicSolnCost(s);
      if (opt_->isCostBetterThan(cost, most) && !opt_->isCostBetterThan(cost, least)) return true;
    }
    return false;
  }
  bool hasInformedMeasure() const override { return false; }
  double getInformedMeasure(const ob::Cost&) const override { return space_->getMeasure(); }

 private:
  ob::StateSamplerPtr cells_;
};

class Shortest : public ob::PathLengthOptimizationObjective {
 public:
  explicit Shortest(const ob::SpaceInformationPtr& si) : ob::PathLengthOptimizationObjective(si) {
    setCostToGoHeuristic(&ob::goalRegionCostToGo);
  }
  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& definition,
                                                   unsigned int max_calls) const override {
    return std::make_shared<InformedCellSampler>(definition, max_calls);
  }
};

}  // namespace

OmplProblem make_problem(const FreeTiles& free, const std::shared_ptr<const SampledCells>& cells,
                         const OmplQuery& query) {
  const auto space = std::make_shared<ob::RealVectorStateSpace>(3);
  ob::RealVectorBounds bounds(3);
  for (unsigned int axis = 0; axis < 3; ++axis)
    bounds.setLow(axis, query.low[axis]), bounds.setHigh(axis, query.high[axis]);
  space->setBounds(bounds);
  const double resolution_m = free.resolution_m();
  space->setStateSamplerAllocator([cells, resolution_m](const ob::StateSpace* s) -> ob::StateSamplerPtr {
    return std::make_shared<CellSampler>(s, cells, resolution_m);
  });
  OmplProblem problem{std::make_shared<ob::SpaceInformation>(space), nullptr};
  problem.space->setStateValidityChecker(
      std::make_shared<ClearState>(problem.space, free, query.clearance_m));
  problem.space->setMotionValidator(std::make_shared<ClearMotion>(problem.space, free, query.clearance_m));
  problem.space->setup();
  problem.definition = std::make_shared<ob::ProblemDefinition>(problem.space);
  ob::ScopedState<> from(space), to(space);
  set_point(from.get(), query.start);
  set_point(to.get(), query.goal);
  problem.definition->setStartAndGoalStates(from, to);
  problem.definition->setOptimizationObjective(std::make_shared<Shortest>(problem.space));
  return problem;
}

}  // namespace karst::core
