// What `karst policy new` writes: the tutorials' own policies, compiled in.
#pragma once
#include <string_view>

namespace karst::tools {

// Of examples/policies/1_nearest, 2_tour, 3_memory.
std::string_view nearest_policy();
std::string_view nearest_test();
std::string_view tour_policy();
std::string_view tour_test();
std::string_view memory_policy();
std::string_view memory_test();

// For all of them; they speak of my_nearest.
std::string_view policy_cmake();
std::string_view policy_readme();

}  // namespace karst::tools
