// Which files a policy's own process may read: Landlock, where the kernel has it (Linux 5.13 and later).
#pragma once
#include <filesystem>
#include <vector>

namespace karst::host {

/// The version of Landlock's interface; 0 if this kernel offers none.
int landlock_version();

/// The paths that a plugin needs to be loaded and to run: the system's libraries, folders of LD_LIBRARY_PATH,
/// its own folder, a few files of /dev, /proc and /sys about this process and the processor.
std::vector<std::filesystem::path> places_to_read(const std::filesystem::path& plugin);

/// From here on the calling process can open only these paths and those below them, read-only, and no other
/// processes' files in /proc. Missing paths are skipped. This cannot be undone. Does nothing without
/// Landlock. Throws core::InputError if the kernel refuses.
void read_only_from(const std::vector<std::filesystem::path>& places);

/// Prevents other unprivileged processes of this user from reading this one's memory and environment: for
/// kernels without Landlock. It also disables core dumps of this process.
void hide_this_process();

}  // namespace karst::host
