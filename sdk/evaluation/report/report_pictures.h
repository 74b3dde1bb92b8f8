// The colour camera's pictures for the report: small, and limited in number.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace karst::evaluation {

/// Scales a JPEG picture to at most `width` pixels wide and encodes it as JPEG again. Throws
/// std::runtime_error with the reason if the bytes are not a picture.
std::vector<std::uint8_t> thumbnail(const std::vector<std::uint8_t>& jpeg, int width);

/// Up to 240 evenly spaced pictures of those in frames.csv: {t, file, position, axis, jpeg in base64}; about
/// 6 kB each. Null if there are none. Missing or damaged files are counted in `problems`.
nlohmann::ordered_json report_pictures(const std::filesystem::path& run_dir,
                                       std::vector<std::string>& problems);

}  // namespace karst::evaluation
