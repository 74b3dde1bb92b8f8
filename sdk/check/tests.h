// The tests of `karst policy check`. Each runs in a process of its own.
#pragma once
#include <string>
#include <vector>

#include "sdk/check/subject.h"

namespace karst::check {

struct Test {
  const char* name;  // group.what
  Level level;       // the lowest at which it is run
  enum class Of {
    file,         // looks at the file as a whole, before a policy of it is chosen
    file_gate,    // the same; if it fails, no later test is run
    policy_gate,  // if it fails, no later test of that policy is run
    policy
  } of;
  const char* description;  // one sentence: what must hold
  void (*run)(Context&);    // throws Failed or NotApplicable
};

/// In the order in which they are run: gates first.
const std::vector<Test>& all_tests();
/// Null if there is none.
const Test* find_test(const std::string& name);

std::vector<Test> entry_tests();
std::vector<Test> lifecycle_tests();
std::vector<Test> request_tests();
std::vector<Test> goal_tests();
std::vector<Test> state_tests();
std::vector<Test> determinism_tests();
std::vector<Test> deadline_tests();
std::vector<Test> service_tests();
std::vector<Test> memory_tests();
std::vector<Test> process_tests();

/// The answers that determinism.fresh_process compares.
std::string answers_to_compare(Context& context);

}  // namespace karst::check
