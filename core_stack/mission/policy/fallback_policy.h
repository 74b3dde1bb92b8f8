// The core's own policy, used when the mission's has failed or makes no progress: nearest frontier by path.
#pragma once
#include "core_stack/mission/policy/policy_port.h"

namespace karst::core {

class FallbackPolicy final : public PolicyPort {
 public:
  std::string name() const override { return "fallback"; }
  Decision decide(const DecisionRequest& request) override;
  void notify(const PolicyEvent&) override {}
};

}  // namespace karst::core
