#include "sdk/check/tests.h"

namespace karst::check {

const std::vector<Test>& all_tests() {
  static const std::vector<Test> all = [] {
    std::vector<Test> out;
    for (const auto& group :
         {entry_tests(), lifecycle_tests(), request_tests(), goal_tests(), state_tests(), determinism_tests(),
          deadline_tests(), service_tests(), memory_tests(), process_tests()})
      out.insert(out.end(), group.begin(), group.end());
    return out;
  }();
  return all;
}

const Test* find_test(const std::string& name) {
  for (const Test& t : all_tests())
    if (name == t.name) return &t;
  return nullptr;
}

}  // namespace karst::check
