// Which files a policy's own process may read: Landlock, where the kernel has it (Linux 5.13 and later).
#pragma once
#include <filesystem>
#include <vector>

namespace karst::host {

/// The version of Landlock's interface; 0 if this kernel offers none.
int landlock_version();

/// What a plugin needs to be opened and to run: the system's libraries, folders of LD_LIBRARY_PATH, its own
/// folder, a few files of /dev, /proc and /sys about this process and the processor.
std::vector<std::filesystem::path> places_to_read(const std::filesystem::path& plugin);

/// From here on the calling process opens nothing but the places and what lies below them, and those to read
/// only; other processes' files in /proc are none of them. What is not there is passed over. It cannot be
/// undone. Does nothing without Landlock. Throws core::InputError if the kernel refuses.
void read_only_from(const std::vector<std::filesystem::path>& places);

/// Keeps other processes of this user, which are not privileged, out of this one's memory and environment:
/// for kernels without Landlock. There will be no core dumps of it either.
void hide_this_process();

}  // namespace karst::host
