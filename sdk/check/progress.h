// What a child that runs a test is doing right now, in a file that its parent reads after a crash or a hang.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

namespace karst::check {

class Progress {
 public:
  /// Maps the file, made if it is not there. Throws core::InputError.
  explicit Progress(const std::filesystem::path& file);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// In the child: around every call into the plugin.
  void enter(const std::string& what);
  void leave();

  /// In the parent: grows with every enter and leave; odd while the child is inside the plugin.
  std::uint64_t count() const;
  /// What it entered last; "" if nothing.
  std::string what() const;

 private:
  struct Shared {
    std::atomic<std::uint64_t> count;
    char what[120];
  };
  Shared* shared_ = nullptr;
};

}  // namespace karst::check
