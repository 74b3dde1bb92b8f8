// What a mesh's coordinates tell of its unit, its upward axis and its origin, and the key that mends it.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "plugins/simulator/cave/mesh_frame.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::cave {

/// Facts of a mesh as it was read, in metres with z up.
struct MeshShape {
  Eigen::AlignedBox3d box;
  /// Of the passages, the median of what is least of height and widths along x and y; 0: not known.
  double passage_m = 0;
  /// Shares of the surface that face along x, y and z: the area-weighted means of the squares of the normals'
  /// components. 0: not known.
  core::Vec3 facing = core::Vec3::Zero();
};
MeshShape shape_of(const RayScene& scene);

struct MeshAdvice {
  std::string finding;  // "read as metres its passages are 150 m across: it is likely in centimetres"
  std::string remedy;   // a line of a cave file: unit mm
  std::string to_give;  // the same, or the option for a mesh that no cave file names: --unit mm
};

/// Findings for a mesh that was read in this frame; none if it looks like a cave in metres with z up.
///
/// - Unit: the size of the passages. No cave has passages 600 m across: that such a mesh is not in metres is
///   said as certain. From 60 m on, centimetres are likely. From 1000 m on it is taken for millimetres (of
///   passages 1 m across and more), below for centimetres. A mesh of more than 100 km is likely in
///   millimetres, and so is one that lies farther from the origin than any place on Earth, or in centimetres.
/// - Axis: the mesh is less than half as thick along y as along x and z, and more of its surface faces along
///   y than along z, as floors and roofs do. That is always said as likely: a straight, narrow canyon is like
///   that, too.
/// - Origin: the mesh lies more than 10 km from it. Eastings of 100 to 900 km and northings of up to 10000 km
///   are likely UTM coordinates.
///
/// Feet cannot be told from metres.
std::vector<MeshAdvice> mesh_advice(const MeshShape& shape, const MeshFrame& frame);

std::string to_text(const MeshAdvice& advice);

/// What to try if y is up in a bare mesh whose shape does not tell; "" where it does. The mesh is no thicker
/// along y than along z, and more of it faces along y than along z; or as much, and it is long, as a tunnel
/// of round or square cross-section or a shaft is. No advice: a canyon and a shaft with z up look like that,
/// too.
std::string axis_hint(const MeshShape& shape, const MeshFrame& frame);

constexpr const char* kReachRule = "coordinates must be finite and within 100 km of the origin";
/// Why a mesh or a cloud of this box is refused: it breaks the rule. Says how far it reaches, and the
/// findings. "" if it keeps the rule.
std::string reach_problem(const Eigen::AlignedBox3d& box, const MeshFrame& frame);

}  // namespace karst::cave
