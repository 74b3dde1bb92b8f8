// Finds out what is known of a mission: from its cave, its vehicle and what policies did in caves like it.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sdk/flight/mission_file.h"
#include "sdk/preflight/preflight.h"
#include "sdk/selection/select.h"

namespace karst::preflight {

struct LookOptions {
  std::vector<std::string> plugins;  // policy plugin files that are searched first
  std::vector<std::string> results;  // stores and experiences; empty: what is installed
  selection::SelectOptions select;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // progress
};

/// What speaks against the mission is a refusal in the result. Throws core::InputError if the mission cannot
/// be judged: a file that cannot be read, a cave without a start (the message proposes one), a policy that
/// cannot be loaded, a team.
Preflight look_at(const flight::Mission& mission, const LookOptions& options);

}  // namespace karst::preflight
