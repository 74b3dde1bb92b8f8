// A decision cycle: it offers the open frontiers to the policy and accepts the first of its goals that the
// vehicle can fly to. It offers narrow passages when nothing else is reachable.
//
// It runs on the map lane.
#pragma once
#include <vector>

#include "core_stack/mission/decision/chosen_frontiers.h"
#include "core_stack/mission/decision/cycle.h"
#include "core_stack/mission/decision/frontier_offers.h"
#include "core_stack/mission/decision/goal_selection.h"
#include "core_stack/mission/policy/policy_with_fallback.h"

namespace karst::core {

class DecisionCycle {
 public:
  /// `policy`, `world` and `home` must outlive it.
  DecisionCycle(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy,
                WorldModel& world, HomeEstimator& home);
  DecisionCycle(const DecisionCycle&) = delete;  // its parts refer to each other
  DecisionCycle& operator=(const DecisionCycle&) = delete;

  CycleResult decide(const CycleInput& input, const Claims& claims);
  /// Notifies the policy of what happened to its goals. Closes the positions of abandoned goals.
  void tell(const std::vector<PolicyEvent>& events, TimeNs now);
  /// Whether the cluster is still open enough to be worth flying to.
  bool cluster_alive(std::uint32_t id) const;

 private:
  /// A request to the policy on one roadmap.
  struct Question {
    DecisionRequest request;
    GoalQuery goals;
  };

  /// Asks about the wide passages, and about the narrow ones if those have nothing left.
  void ask(DecidedBy by, const CycleInput& input, const Claims& claims, CycleResult& result);
  Question ask_about(const ClearanceRoadmap& roadmap, const CycleInput& input, const Claims& claims);
  DecisionRequest request(const ClearanceRoadmap& roadmap, const CycleInput& input);
  void answer(const Question& question, DecidedBy by, CycleResult& result);
  void choose(const Question& question, const PolicyAnswer& answer, CycleResult& result);
  void note_chosen(const Goal& goal, const CycleInput& input);

  VehicleDescription vehicle_;
  double max_speed_mps_, max_acceleration_mps2_;
  WorldModel* world_;
  HomeEstimator* home_;
  GoalLedger ledger_;
  ChosenFrontiers chosen_;
  FrontierOffers offers_;
  GoalSelection selection_;
  PolicyWithFallback policy_;
  std::uint32_t sequence_ = 0;  // of the last request
};

}  // namespace karst::core
