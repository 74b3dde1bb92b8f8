// Names of policies: which are valid, and the resulting name of the class.
#pragma once
#include <string>

namespace karst::tools {

/// "" if a new policy can have that name, otherwise the reason: its form, a keyword of C++ or CMake, or an
/// existing policy with that name.
std::string name_fault(const std::string& name);

/// The same for a file of Python: "" or why the name cannot be a module's.
std::string module_name_fault(const std::string& name);

/// For example DeepFirst for deep_first.
std::string class_name(const std::string& name);

}  // namespace karst::tools
