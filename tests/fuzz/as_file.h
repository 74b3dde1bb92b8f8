// What every fuzzer here does: the bytes become a file, a reader reads it, and the only way to refuse it is
// an InputError. Anything else that is thrown, a crash, or what a sanitizer reports is a finding.
#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "core_stack/common/error.h"

namespace karst::fuzz {

/// A file of this process in memory, written anew each time.
inline std::string as_file(const std::uint8_t* data, std::size_t size, const std::string& ending) {
  const std::string path = "/dev/shm/karst_fuzz_" + std::to_string(getpid()) + ending;
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) std::abort();
  close(file);
  return path;
}

template <typename Read>
int read_as_file(const std::uint8_t* data, std::size_t size, const std::string& ending, Read read) {
  const std::string path = as_file(data, size, ending);
  try {
    read(path);
  } catch (const core::InputError&) {
  }
  unlink(path.c_str());
  return 0;
}

}  // namespace karst::fuzz
