// A file that is written piece by piece, and is there whole or not at all.
#pragma once
#include <filesystem>
#include <fstream>

namespace karst::mcap {

class PartFile {
 public:
  /// Written beside `file` until commit(); devices and pipes directly. Throws core::InputError if it cannot
  /// be made.
  explicit PartFile(std::filesystem::path file);
  /// Without commit(), nothing remains.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  std::ostream& stream() { return out_; }
  /// Throws core::InputError, with the system's reason, if a write has failed.
  void check();
  /// As check(), and gives the file its name.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& reason);

  const std::filesystem::path file_;
  const bool device_;
  const std::filesystem::path part_;
  std::ofstream out_;
  bool done_ = false;
};

}  // namespace karst::mcap
