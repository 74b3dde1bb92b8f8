// A policy that does as the test says.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core_stack/mission/policy/policy_port.h"

namespace karst::core {

struct ScriptedPolicy final : PolicyPort {
  std::function<Decision(const DecisionRequest&)> script = [](const DecisionRequest&) { return Decision{}; };
  std::vector<PolicyEvent> heard;
  std::string name() const override { return "scripted"; }
  Decision decide(const DecisionRequest& r) override { return script(r); }
  void notify(const PolicyEvent& e) override { heard.push_back(e); }
};

}  // namespace karst::core
