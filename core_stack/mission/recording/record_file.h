// One file of the run directory, which only grows.
#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core_stack/mission/recording/disk_writer.h"

namespace karst::core {

class RecordFile {
 public:
  /// Makes the file, emptied. Through `disk`, if given, which outlives it. Throws InputError if it cannot be
  /// made.
  void open(const std::filesystem::path& path, DiskWriter* disk);
  bool empty() const { return empty_; }  // nothing was added
  bool is_open() const { return disk_ != nullptr || out_.is_open(); }

  /// Added to the buffer; written by the next flush(), or before it where the buffer is full.
  RecordFile& operator<<(std::string_view bytes);
  RecordFile& operator<<(char c) { return *this << std::string_view(&c, 1); }

  /// Hands on what is buffered; false once a write has failed. A file that is not open has nothing to write.
  bool flush();
  /// The same of the last bytes: with a disk writer it may wait for its thread.
  bool close();

 private:
  std::ofstream out_;  // without a disk writer
  DiskWriter* disk_ = nullptr;
  DiskWriter::File file_{};
  bool empty_ = true;
  std::string buffer_;  // for the disk writer
};

}  // namespace karst::core
