// A policy for whole missions of a stated length.
#pragma once
#include "core_stack/mission/policy/fallback_policy.h"

namespace karst::core {

/// The nearest frontier, and home after a while.
class Tourist final : public PolicyPort {
 public:
  explicit Tourist(TimeNs home_after) : home_after_(home_after) {}
  std::string name() const override { return "tourist"; }
  Decision decide(const DecisionRequest& request) override {
    if (request.stamp < home_after_) return nearest_.decide(request);
    Decision home;
    home.outcome = Outcome::go_home;
    return home;
  }
  void notify(const PolicyEvent&) override {}

 private:
  FallbackPolicy nearest_;
  TimeNs home_after_;
};

}  // namespace karst::core
