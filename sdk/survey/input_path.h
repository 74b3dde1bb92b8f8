// Which file `input NAME` means.
#pragma once
#include <filesystem>
#include <string>

namespace karst::survey {

struct InputPath {
  std::filesystem::path path;  // empty: there is none
  bool other_case = false;     // found only because upper and lower case were not told apart
};

/// NAME, NAME.th or NAME.th2, from `folder`. Many surveys were written where file systems do not tell upper
/// from lower case: if nothing fits exactly, a name that differs in case alone does, the first by its bytes.
InputPath input_path(const std::filesystem::path& folder, const std::string& name);

}  // namespace karst::survey
