// The files a flight writes into its run directory (docs/run_directory.md): none may be there before it, and
// none stays if nothing flew.
#pragma once
#include <filesystem>

namespace karst::tools {

/// Throws core::InputError naming a file of these that is there.
void refuse_taken(const std::filesystem::path& run_dir);

/// A run directory's claim on its name: unless kept, everything written since is taken away again.
class RunClaim {
 public:
  /// Refuses a directory that is taken.
  explicit RunClaim(std::filesystem::path run_dir);
  ~RunClaim();
  RunClaim(const RunClaim&) = delete;
  RunClaim& operator=(const RunClaim&) = delete;
  void keep() { kept_ = true; }

 private:
  std::filesystem::path run_dir_;
  bool was_there_ = false, kept_ = false;
};

}  // namespace karst::tools
