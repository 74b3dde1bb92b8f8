// The colour camera's pictures as the report shows them: small, and no more than the page can hold.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace karst::evaluation {

/// A JPEG file's picture, at most `width` pixels wide, as a JPEG again. Throws std::runtime_error with the
/// reason if the bytes are no picture.
std::vector<std::uint8_t> thumbnail(const std::vector<std::uint8_t>& jpeg, int width);

/// Of the pictures that frames.csv names, up to 240 evenly spread: {t, file, position, axis, jpeg in base64};
/// about 6 kB each. Null if there are none. Files that are missing or damaged are counted in `problems`.
nlohmann::ordered_json report_pictures(const std::filesystem::path& run_dir,
                                       std::vector<std::string>& problems);

}  // namespace karst::evaluation
