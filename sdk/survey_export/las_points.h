// Points as LAS 1.2 (ASPRS, LAS Specification 1.2, 2008), point format 0.
#pragma once
#include <span>
#include <string>

#include "core_stack/common/geometry.h"

namespace karst::survey_export {

/// The file's bytes. Coordinates are in millimetres from the whole metre below the least one of each axis, so
/// that those of a national grid keep their millimetres. No date: the same flight gives the same bytes.
/// Throws core::InputError that names `file` if the points span more than two thousand kilometres.
std::string las_bytes(std::span<const core::Vec3> points, const std::string& file);

}  // namespace karst::survey_export
