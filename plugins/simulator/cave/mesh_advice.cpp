#include "plugins/simulator/cave/mesh_advice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/air_columns.h"

namespace karst::cave {

using core::format_text;
using core::Vec3;

namespace {

constexpr double kNoPassage_m = 600;          // wider than any passage
constexpr double kWidePassage_m = 60;         // wider than nearly all
constexpr double kLowMillimetres_m = 1e3;     // what 1 m is in millimetres, read as metres
constexpr double kSureMillimetres_m = 6e3;    // in centimetres it would be wider than nearly all
constexpr double kFarOrigin_m = 1e4;          // floats resolve 1 mm there
constexpr double kFarthestOnEarth_m = 2.1e7;  // half its circumference, and more than any map's coordinates
constexpr double kFarthestNorthing_m = 1e7;   // of UTM

struct OtherUnit {
  MeshAdvice advice;
  double in_m;  // of the unit that it seems to be in
};

OtherUnit other_unit(const std::string& why, const char* how_sure, bool millimetres, const MeshFrame& frame) {
  const char* name = millimetres ? "millimetres" : "centimetres";
  std::string remedy = millimetres ? "unit mm" : "unit cm";
  if (frame.states_its_own) remedy = millimetres ? "scale 0.001" : "scale 0.01";
  return {{why + ": " + how_sure + " in " + name, remedy, ""}, millimetres ? 1e-3 : 1e-2};
}

/// Along the axis along which it is farthest.
double away_from_origin_m(const Eigen::AlignedBox3d& box) {
  return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
}

/// Of a file that is read as metres.
std::optional<OtherUnit> unit_of(const MeshShape& shape, const MeshFrame& frame) {
  const double length_m = shape.box.sizes().maxCoeff(), passage_m = shape.passage_m;
  if (frame.metres_per_unit != 1) return std::nullopt;
  const std::string wide = format_text("read as metres its passages are %.0f m across", passage_m);
  if (passage_m >= kSureMillimetres_m) return other_unit(wide, "it is", true, frame);
  if (passage_m >= kLowMillimetres_m)
    return other_unit(wide, "it is in another unit, most likely", true, frame);
  if (passage_m >= kNoPassage_m) return other_unit(wide, "it is in another unit, most likely", false, frame);
  if (passage_m >= kWidePassage_m) return other_unit(wide, "it is likely", false, frame);
  if (length_m > kFarthestVertex_m && length_m / 1000 <= kFarthestVertex_m)
    return other_unit(format_text("read as metres it is %.0f km long", length_m / 1000), "it is likely", true,
                      frame);
  if (const double away_m = away_from_origin_m(shape.box); away_m > kFarthestOnEarth_m)
    return other_unit(
        format_text("read as metres it lies %.0f km from the origin, farther than any place on Earth",
                    away_m / 1000),
        "it is likely", away_m / 100 > kFarthestNorthing_m, frame);
  return std::nullopt;
}

std::optional<MeshAdvice> axis_of(const MeshShape& shape, const MeshFrame& frame) {
  constexpr double kThin = 0.5, kFacing = 1.2;
  if (frame.states_its_own) return std::nullopt;
  const Vec3 size = shape.box.sizes();
  if (size.y() >= kThin * std::min(size.x(), size.z()) || shape.facing.y() <= kFacing * shape.facing.z())
    return std::nullopt;
  const bool is_z = frame.up == core::UpAxis::z;
  return MeshAdvice{
      format_text("read with %s up it is %.1f m high and %.1f m wide, and %.0f %% of its surface stands "
                  "upright: it likely has %s up",
                  is_z ? "z" : "y", size.z(), size.y(), 100 * (shape.facing.x() + shape.facing.y()),
                  is_z ? "y" : "z"),
      is_z ? "up y" : "up z", ""};
}

/// A whole number of units, and of metres if these are longer.
double rounded_place(double v, double metres_per_unit) {
  const double step = std::max(1.0, std::round(1 / metres_per_unit));
  return std::round(v / step) * step + 0.0;  // no negative zero
}

/// `in_m`: the unit that the file seems to be in.
std::optional<MeshAdvice> origin_of(const MeshShape& shape, const MeshFrame& frame, double in_m) {
  const Vec3 &low = shape.box.min(), &high = shape.box.max();
  const double away_m = in_m * away_from_origin_m(shape.box);
  // A mesh that is large, and not far away, is no case for an offset.
  if (away_m < kFarOrigin_m || away_m < 2 * in_m * shape.box.sizes().maxCoeff()) return std::nullopt;
  const Vec3 middle((low.x() + high.x()) / 2, (low.y() + high.y()) / 2, low.z());
  const double east_m = in_m * middle.x(), north_m = in_m * middle.y();
  const bool utm =
      east_m > 1e5 && east_m < 9e5 && std::abs(north_m) > kFarOrigin_m && std::abs(north_m) < 1e7;
  const Vec3 origin = to_file(frame, middle);
  const double unit_m = frame.metres_per_unit * in_m;
  return MeshAdvice{format_text("it lies %.0f km from the origin%s", away_m / 1000,
                                utm ? ", likely in UTM coordinates" : ""),
                    format_text("offset \"%.0f %.0f %.0f\"", rounded_place(origin.x(), unit_m),
                                rounded_place(origin.y(), unit_m), rounded_place(origin.z(), unit_m)),
                    ""};
}

/// The least of height and widths at the middle of the column.
double passage_size_m(const RayScene& scene, const AirColumn& column) {
  constexpr double kFar_m = 1e6;
  const Vec3 middle = column.floor + Vec3(0, 0, column.height_m / 2);
  double least_m = column.height_m;
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0)})
    least_m = std::min(least_m, scene.ray_cast(middle, d, kFar_m) + scene.ray_cast(middle, -d, kFar_m));
  return least_m;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

MeshShape shape_of(const RayScene& scene) {
  constexpr int kLines = 400;
  MeshShape shape;
  const TriangleMesh& mesh = scene.mesh();
  double area_twice = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
               c = mesh.vertices[t[2]].cast<double>();
    shape.box.extend(a).extend(b).extend(c);
    const Vec3 normal = (b - a).cross(c - a);  // of twice the area's length
    if (const double n = normal.norm(); n > 0) {
      shape.facing += normal.cwiseAbs2() / n;
      area_twice += n;
    }
  }
  if (area_twice > 0) shape.facing /= area_twice;
  std::vector<double> sizes_m;
  for (const AirColumn& column : air_columns(scene, kLines)) sizes_m.push_back(passage_size_m(scene, column));
  shape.passage_m = median(std::move(sizes_m));
  return shape;
}

std::vector<MeshAdvice> mesh_advice(const MeshShape& shape, const MeshFrame& frame) {
  std::vector<MeshAdvice> all;
  if (shape.box.isEmpty()) return all;
  const std::optional<OtherUnit> unit = unit_of(shape, frame);
  if (unit) all.push_back(unit->advice);
  if (const auto axis = axis_of(shape, frame)) all.push_back(*axis);
  if (const auto origin = origin_of(shape, frame, unit ? unit->in_m : 1.0)) all.push_back(*origin);
  for (MeshAdvice& a : all) a.to_give = (frame.given_as_options ? "--" : "") + a.remedy;
  return all;
}

std::string to_text(const MeshAdvice& advice) { return advice.finding + " (" + advice.to_give + ")"; }

std::string axis_hint(const MeshShape& shape, const MeshFrame& frame) {
  constexpr double kAsThick = 1.2, kAsMuch = 0.9, kMore = 1.25, kLong = 3;
  const bool stated = frame.states_its_own || !frame.given_as_options || frame.up != core::UpAxis::z;
  if (stated || shape.box.isEmpty() || axis_of(shape, frame)) return "";
  const Vec3 size = shape.box.sizes();
  if (size.y() > kAsThick * size.z()) return "";
  const bool more = shape.facing.y() >= kMore * shape.facing.z(),
             as_much = shape.facing.y() >= kAsMuch * shape.facing.z(),
             is_long = std::max(size.x(), size.z()) >= kLong * size.y();
  if (!more && !(as_much && is_long)) return "";
  return "its shape does not tell whether y or z points up; if y is up in this file, pass --up y";
}

std::string reach_problem(const Eigen::AlignedBox3d& box, const MeshFrame& frame) {
  if (box.isEmpty()) return "";
  const Vec3 &low = box.min(), &high = box.max();
  if (away_from_origin_m(box) <= kFarthestVertex_m) return "";
  std::string why = kReachRule + format_text("; these reach from %.0f %.0f %.0f to %.0f %.0f %.0f m", low.x(),
                                             low.y(), low.z(), high.x(), high.y(), high.z());
  MeshShape shape;
  shape.box = box;
  for (const MeshAdvice& a : mesh_advice(shape, frame)) why += "; " + to_text(a);
  return why;
}

}  // namespace karst::cave
