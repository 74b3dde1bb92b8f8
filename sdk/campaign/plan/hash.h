// SHA-256, as `sha256sum` prints it: identifies what was flown by its bytes.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace karst::campaign {

std::string sha256(std::string_view bytes);
/// Throws core::InputError if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace karst::campaign
