// Files that `karst policy new` writes: the policies of the tutorials, compiled in.
#pragma once
#include <string_view>

namespace karst::tools {

// From examples/policies/1_nearest, 2_tour, 3_memory.
std::string_view nearest_policy();
std::string_view nearest_test();
std::string_view tour_policy();
std::string_view tour_test();
std::string_view memory_policy();
std::string_view memory_test();

// Common to those; the text names my_nearest.
std::string_view policy_cmake();

// From examples/policies/plain_c.
std::string_view c_policy();
std::string_view c_test();
std::string_view c_cmake();

// From examples/policies/python.
std::string_view python_policy();
std::string_view python_test();
std::string_view python_readme();

// Common to those that are compiled; the text names my_nearest.
std::string_view policy_readme();

}  // namespace karst::tools
