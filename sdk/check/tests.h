// The tests of `karst policy check`. Each runs in its own process.
#pragma once
#include <string>
#include <vector>

#include "sdk/check/subject.h"

namespace karst::check {

struct Test {
  const char* name;  // group.name
  Level level;       // the lowest level at which it is run
  enum class Of {
    file,         // tests the file as a whole, before one of its policies is chosen
    file_gate,    // likewise; if it fails, no later test is run
    policy_gate,  // if it fails, no later test of that policy is run
    policy
  } of;
  const char* description;  // one sentence: what must hold
  void (*run)(Context&);    // throws Failed or NotApplicable
  /// Below its level it is run, too, and a failure is a note.
  bool noted_below = false;
};

/// In order of execution: gates first.
const std::vector<Test>& all_tests();
/// Null if there is no such test.
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

/// The answers compared by determinism.fresh_process.
std::string answers_to_compare(Context& context);

}  // namespace karst::check
