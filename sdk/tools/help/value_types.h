// What the value of an option or argument is, as help shows it: shells complete files, folders and policies.
#pragma once

namespace karst::tools {

inline constexpr const char* kFile = "FILE";  // or a run directory
inline constexpr const char* kFolder = "FOLDER";
inline constexpr const char* kPolicy = "POLICY";
inline constexpr const char* kPolicyOrFile = "POLICY|FILE";

}  // namespace karst::tools
