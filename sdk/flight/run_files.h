// The files a flight writes into its run directory (docs/run_directory.md): none may be there before it, and
// none stays if nothing flew.
#pragma once
#include <filesystem>
#include <string>

namespace karst::flight {

/// As given, without `x/..`: a path is looked at before what it leads through is made.
std::filesystem::path run_dir_of(const std::string& out);

/// Throws core::InputError if a flight's run directory, alone or of a team, is there: no other results go in.
void refuse_run(const std::filesystem::path& folder);

/// Throws core::InputError naming a file of these that is there.
void refuse_taken(const std::filesystem::path& run_dir);

/// A run directory's claim on its name: unless kept, everything written since is taken away again.
class RunClaim {
 public:
  /// Makes the directory and locks it. Refuses one that is taken or locked, and leaves it as it is.
  explicit RunClaim(std::filesystem::path run_dir);
  ~RunClaim();
  RunClaim(const RunClaim&) = delete;
  RunClaim& operator=(const RunClaim&) = delete;
  void keep() { kept_ = true; }

 private:
  std::filesystem::path run_dir_;
  bool was_there_ = false, kept_ = false;
};

}  // namespace karst::flight
