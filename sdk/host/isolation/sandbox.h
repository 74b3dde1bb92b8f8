// What a policy's own process may use of the machine. All of it holds before the plugin's first line runs,
// for all its threads, and cannot be undone.
//
// It may compute, allocate up to its limit, run threads, sleep, read the clock and open some files for
// reading (file_access.h). It may not open a file to write, make a file or a socket, start or signal another
// process, run a program, or look into one. What is refused fails with EPERM or EACCES, so a library that
// tries goes on without. A call of another architecture (x32, i386) ends the process.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace karst::host {

/// Of the calling process, before it has other threads. Throws core::InputError if this machine's kernel does
/// not offer it: a policy that was to be confined does not run unconfined.
void confine_this_process(std::uint64_t memory_limit_bytes,
                          const std::vector<std::filesystem::path>& readable);

/// A sanitizer's shadow of all memory does not fit any limit: in such a build there is none.
constexpr bool memory_can_be_limited() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

}  // namespace karst::host
