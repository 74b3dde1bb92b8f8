// The current activity of a test's child process, in a file that its parent reads after a crash or a hang.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

namespace karst::check {

class Progress {
 public:
  /// Maps the file; creates it if missing. Throws core::InputError.
  explicit Progress(const std::filesystem::path& file);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// In the child: called around every call into the plugin.
  void enter(const std::string& what);
  void leave();

  /// In the parent: increases with every enter and leave; odd while the child is inside the plugin.
  std::uint64_t count() const;
  /// The last text passed to enter; "" if none.
  std::string what() const;

 private:
  struct Shared {
    std::atomic<std::uint64_t> count;
    char what[120];
  };
  Shared* shared_ = nullptr;
};

}  // namespace karst::check
