// Writes a file completely or not at all.
#pragma once
#include <filesystem>
#include <string_view>

namespace karst::evaluation {

/// Writes beside `file` and renames; writes devices and pipes directly. InputError gives the system's reason.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace karst::evaluation
