// What the value of an option or argument is, as help shows it: shells complete files, folders, policies,
// metrics and the keys of settings.
#pragma once

namespace karst::tools {

inline constexpr const char* kFile = "FILE";  // or a run directory
inline constexpr const char* kFolder = "FOLDER";
inline constexpr const char* kPolicy = "POLICY";
inline constexpr const char* kPolicyOrFile = "POLICY|FILE";
inline constexpr const char* kMetric = "METRIC";      // one that campaigns compare
inline constexpr const char* kSetting = "KEY=VALUE";  // see CommandOption::keys

}  // namespace karst::tools
