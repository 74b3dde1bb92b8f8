// Lists the available policies: from names to files, without running plugin code in this process.
//
// Order: files named explicitly, KARST_PLUGIN_PATH (ignored in a privileged process), the user's folder,
// the installed folder next to the executable. The first file that offers a name wins. Each candidate is
// opened in a child process, so that one that crashes or hangs costs one line in a list.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace karst::host {

/// The files and folders that are searched for policies.
struct SearchPath {
  std::vector<std::string> files;    // named explicitly, in order
  std::vector<std::string> folders;  // after the files, in order; those that do not exist are skipped
  double probe_limit_s = 5.0;        // a candidate that takes longer to report its name is broken
};

/// The search path of this process.
SearchPath default_search_path(std::vector<std::string> plugin_files = {});

/// Numbered as in the ABI (KARST_PARAMETER_REAL and so on).
enum class ParameterType { real = 1, integer, boolean, text };
constexpr auto names_of(ParameterType) {
  using enum ParameterType;
  return std::to_array<core::Named<ParameterType>>(
      {{real, "real"}, {integer, "integer"}, {boolean, "boolean"}, {text, "text"}});
}

struct ParameterListing {
  std::string id;
  ParameterType type = ParameterType::real;
  std::string unit, default_text, help;
  double low = 0, high = 0;          // for numbers
  std::vector<std::string> choices;  // for texts
};

/// One policy, or one file that could not be read as a plugin.
struct PolicyListing {
  std::string file;
  std::string broken;  // reason; empty if the file is sound
  std::string id, name, version, one_line;
  std::string abi;          // "1.0"
  std::string shadowed_by;  // the file earlier in the order that offers the same id; "" if none
  std::vector<ParameterListing> parameters;
};

/// All policies and broken candidates, in the order of the search; within a folder by file name.
std::vector<PolicyListing> list_policies(const SearchPath& path);

}  // namespace karst::host
