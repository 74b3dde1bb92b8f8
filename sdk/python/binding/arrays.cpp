#include "sdk/python/binding/arrays.h"

#include <cstddef>

namespace karst::python {
namespace {

/// A record type, field by field.
class Fields {
 public:
  Fields& add(const char* name, const char* format, std::size_t offset) {
    names_.append(name);
    formats_.append(format);
    offsets_.append(offset);
    return *this;
  }
  py::dtype type(std::size_t item_size) const {
    py::dict fields;
    fields["names"] = names_;
    fields["formats"] = formats_;
    fields["offsets"] = offsets_;
    fields["itemsize"] = item_size;
    return py::dtype::from_args(fields);
  }

 private:
  py::list names_, formats_, offsets_;
};

constexpr const char *kReal = "f8", *kVector = "(3,)f8", *kCount = "u4", *kWide = "u8", *kStamp = "i8";

std::string shape_of(const Doubles& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

/// The number of rows of `columns` each.
std::size_t rows_of(const Doubles& array, py::ssize_t columns, const std::string& what) {
  if (array.ndim() == 1 && array.shape(0) == columns) return 1;
  if (array.ndim() == 1 && array.shape(0) == 0) return 0;  // an empty list
  if (array.ndim() == 2 && array.shape(1) == columns) return static_cast<std::size_t>(array.shape(0));
  const std::string n = std::to_string(columns);
  throw Error(what + " must have the shape (n, " + n + ") or (" + n + ",), not " + shape_of(array),
              KARST_ERROR_ARGUMENT);
}

}  // namespace

template <>
py::dtype dtype_of<karst_frontier_cluster_t>() {
  using T = karst_frontier_cluster_t;
  return Fields()
      .add("id", kCount, offsetof(T, id))
      .add("cells", kCount, offsetof(T, cells))
      .add("centroid", kVector, offsetof(T, centroid))
      .add("low", kVector, offsetof(T, bounds.low))
      .add("high", kVector, offsetof(T, bounds.high))
      .add("normal", kVector, offsetof(T, normal))
      .add("unknown_cells", kCount, offsetof(T, unknown_cells))
      .add("free_cells", kCount, offsetof(T, free_cells))
      .add("viewpoint", kVector, offsetof(T, viewpoint.position))
      .add("viewpoint_heading_rad", kReal, offsetof(T, viewpoint.heading_rad))
      .add("path_length_m", kReal, offsetof(T, path_length_m))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_teammate_t>() {
  using T = karst_teammate_t;
  return Fields()
      .add("id", kCount, offsetof(T, id))
      .add("stamp_ns", kStamp, offsetof(T, stamp_ns))
      .add("position", kVector, offsetof(T, position))
      .add("velocity", kVector, offsetof(T, velocity))
      .add("goal", kVector, offsetof(T, goal))
      .add("seconds_before_homing", kReal, offsetof(T, seconds_before_homing))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_ray_end_t>() {
  using T = karst_ray_end_t;
  return Fields()
      .add("center", kVector, offsetof(T, center))
      .add("length_m", kReal, offsetof(T, length_m))
      .add("cell", "u1", offsetof(T, state))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_passage_t>() {
  using T = karst_passage_t;
  return Fields()
      .add("ends", "(2,)u4", offsetof(T, ends))
      .add("length_m", kReal, offsetof(T, length_m))
      .add("mean_width_m", kReal, offsetof(T, mean_width_m))
      .add("least_width_m", kReal, offsetof(T, least_width_m))
      .add("mean_height_m", kReal, offsetof(T, mean_height_m))
      .add("least_height_m", kReal, offsetof(T, least_height_m))
      .add("volume_m3", kReal, offsetof(T, volume_m3))
      .add("frontier_m2", kReal, offsetof(T, frontier_m2))
      .add("middle", kVector, offsetof(T, middle))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_passage_end_t>() {
  using T = karst_passage_end_t;
  return Fields()
      .add("position", kVector, offsetof(T, position))
      .add("from_start_m", kReal, offsetof(T, from_start_m))
      .add("width_m", kReal, offsetof(T, width_m))
      .add("height_m", kReal, offsetof(T, height_m))
      .add("volume_m3", kReal, offsetof(T, volume_m3))
      .add("frontier_m2", kReal, offsetof(T, frontier_m2))
      .add("kind", kCount, offsetof(T, kind))
      .add("ways", kCount, offsetof(T, ways))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_passage_place_t>() {
  using T = karst_passage_place_t;
  return Fields()
      .add("passage", kCount, offsetof(T, passage))
      .add("end", kCount, offsetof(T, end))
      .add("from_start_m", kReal, offsetof(T, from_start_m))
      .add("width_m", kReal, offsetof(T, width_m))
      .add("height_m", kReal, offsetof(T, height_m))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_surface_cell_t>() {
  using T = karst_surface_cell_t;
  return Fields()
      .add("center", kVector, offsetof(T, center))
      .add("normal", kVector, offsetof(T, normal))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_survey_leg_t>() {
  using T = karst_survey_leg_t;
  return Fields()
      .add("from_station", kWide, offsetof(T, from_station))
      .add("to_station", kWide, offsetof(T, to_station))
      .add("from_position", kVector, offsetof(T, from))
      .add("to_position", kVector, offsetof(T, to))
      .add("from_left_right_up_down_m", "(4,)f8", offsetof(T, from_size))
      .add("to_left_right_up_down_m", "(4,)f8", offsetof(T, to_size))
      .type(sizeof(T));
}

template <>
py::dtype dtype_of<karst_survey_lead_t>() {
  using T = karst_survey_lead_t;
  return Fields()
      .add("position", kVector, offsetof(T, position))
      .add("station", kWide, offsetof(T, station))
      .add("kind", kCount, offsetof(T, kind))
      .type(sizeof(T));
}

std::vector<Vec3> points_of(const Doubles& array, const std::string& what) {
  const auto* first = reinterpret_cast<const Vec3*>(array.data());
  return {first, first + rows_of(array, 3, what)};
}

Vec3 point_of(const Doubles& array, const std::string& what) {
  const std::vector<Vec3> points = points_of(array, what);
  if (points.size() == 1) return points.front();
  throw Error(what + " must be one place, (3,), not " + shape_of(array), KARST_ERROR_ARGUMENT);
}

std::vector<Viewpoint> viewpoints_of(const Doubles& array) {
  static_assert(sizeof(Viewpoint) == 4 * sizeof(double), "x, y, z, heading");
  const auto* first = reinterpret_cast<const Viewpoint*>(array.data());
  return {first, first + rows_of(array, 4, "viewpoints")};
}

py::array_t<double> array_of(const Vec3& v) { return py::array_t<double>(3, &v.x); }
py::array_t<double> array_of(const std::vector<Vec3>& all) {
  const double* first = all.empty() ? nullptr : &all.front().x;
  return py::array_t<double>({static_cast<py::ssize_t>(all.size()), py::ssize_t{3}}, first);
}
py::array_t<double> array_of(const karst_quaternion_t& q) { return py::array_t<double>(4, &q.w); }

}  // namespace karst::python
