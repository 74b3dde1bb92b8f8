// Writes a file whole or not at all.
#pragma once
#include <filesystem>
#include <string_view>

namespace karst::evaluation {

/// Writes beside `file` and renames, into a device or pipe at once; InputError says why the system refuses.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace karst::evaluation
