// Pictures as JPEG files, through libjpeg-turbo.
#pragma once
#include <filesystem>
#include <vector>

#include "core_stack/vehicle/rgb_camera_model.h"

namespace karst::core {

/// The bytes of a JPEG file, quality 90, full colour resolution: features must survive it. Throws
/// std::runtime_error if the picture does not fit its model.
std::vector<std::uint8_t> jpeg_of(const RgbFrame& frame);
/// Throws InputError if the file cannot be written whole.
void write_jpeg(const std::filesystem::path& path, const RgbFrame& frame);

}  // namespace karst::core
