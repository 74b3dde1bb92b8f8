// A folder of this program's own, removed with all that is in it.
#pragma once
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "core_stack/common/error.h"

namespace karst::core {

class TemporaryFolder {
 public:
  /// In the folder for temporary files (TMPDIR, else /tmp): "karst-PURPOSE-" and six letters.
  explicit TemporaryFolder(const std::string& purpose) {
    std::string name = (std::filesystem::temp_directory_path() / ("karst-" + purpose + "-XXXXXX")).string();
    if (mkdtemp(name.data()) == nullptr)
      throw InputError(name, "", std::string("cannot be made: ") + std::strerror(errno));
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace karst::core
