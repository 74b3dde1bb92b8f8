// A `cavern` in PATH that does something before the real one runs.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <string>

#include "core_stack/common/program_in_path.h"
#include "tests/unit/replay/folder.h"

namespace karst::test {

class FakeCavern {
 public:
  /// Lines of sh; $file is what cavern shall read: readings.svx, or probe.svx.
  explicit FakeCavern(const std::string& first) {
    const std::string real = core::program_in_path("cavern").value_or("cavern");
    const std::string script = "#!/bin/sh\nfor file; do :; done\n" + first + "\nexec " + real + " \"$@\"\n";
    std::filesystem::permissions(folder_.write("cavern", script), std::filesystem::perms::owner_all);
    setenv("PATH", (folder_.path().string() + ":" + before_).c_str(), 1);
  }
  ~FakeCavern() { setenv("PATH", before_.c_str(), 1); }
  FakeCavern(const FakeCavern&) = delete;
  FakeCavern& operator=(const FakeCavern&) = delete;

 private:
  const Folder folder_;
  const std::string before_ = getenv("PATH") != nullptr ? getenv("PATH") : "";
};

}  // namespace karst::test
