// Names of policies: what one can be called, and what its class is called then.
#pragma once
#include <string>

namespace karst::tools {

/// "" if a new policy can have that name, otherwise why not: its form, a word of C++ or CMake, or a policy
/// that has it.
std::string name_fault(const std::string& name);

/// deep_first: DeepFirst.
std::string class_name(const std::string& name);

}  // namespace karst::tools
