// Opening what a user, or a file of somebody else's, names. Only a regular file is read: a FIFO would block,
// a device or a file of the kernel (/proc) may never end, and a directory opens without an error.
#pragma once
#include <cstdint>
#include <fstream>
#include <string>

namespace karst::core {

/// Each kind of file has a size above which it is refused instead of filling the memory.
constexpr std::uintmax_t kMiB = 1u << 20;
constexpr std::uintmax_t kMaxTextFileBytes = 64 * kMiB;      // JSON, pictures
constexpr std::uintmax_t kMaxPluginBytes = 1024 * kMiB;      // shared objects, with debugging information
constexpr std::uintmax_t kMaxScanFileBytes = 4096 * kMiB;    // point clouds, read whole
constexpr std::uintmax_t kMaxMeshFileBytes = 4096 * kMiB;    // read whole
constexpr std::uintmax_t kMaxRecordFileBytes = 4096 * kMiB;  // what a run wrote: tables, events, poses
constexpr std::uintmax_t kMaxDataFileBytes = 1024 * 1024 * kMiB;  // read piece by piece: maps, stores, IMU

/// Throws InputError ("FILE: is a FIFO, not a regular file") unless `file` is a regular file of at most
/// `max_bytes`. For libraries that open files by name; whoever can, opens with `open_input`.
void check_input(const std::string& file, std::uintmax_t max_bytes);

/// A binary stream of the very file that was checked. Throws InputError; never blocks.
std::ifstream open_input(const std::string& file, std::uintmax_t max_bytes);

/// All bytes of a file. Throws InputError.
std::string read_input(const std::string& file, std::uintmax_t max_bytes);

}  // namespace karst::core
