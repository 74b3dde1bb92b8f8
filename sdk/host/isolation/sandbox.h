// The resources that a policy's own process may use. All limits hold before the plugin's first line runs, for
// all its threads, and cannot be undone.
//
// It may compute, allocate up to its limit, run threads, sleep, read the clock and open some files for
// reading (file_access.h). It may not open a file to write, make a file or a socket, start or signal another
// process, run a program, or inspect one. A refused call fails with EPERM or EACCES, so a library that tries
// can continue without it. A call of another architecture (x32, i386) ends the process.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace karst::host {

/// Confines the calling process; call it before there are other threads. Throws core::InputError if this
/// kernel does not support it: a policy that should be confined must not run unconfined.
void confine_this_process(std::uint64_t memory_limit_bytes,
                          const std::vector<std::filesystem::path>& readable);

}  // namespace karst::host
