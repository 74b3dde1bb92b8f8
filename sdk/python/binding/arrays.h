// Between numpy's arrays and the values of the policy ABI.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include <karst/imaged.h>
#include <karst/survey.h>
#include <karst/types.h>

namespace karst::python {

namespace py = pybind11;

/// The numpy type of records of an ABI struct: its fields by name, at their places, without the reserved
/// ones.
template <class Struct>
py::dtype dtype_of();

template <>
py::dtype dtype_of<karst_frontier_cluster_t>();
template <>
py::dtype dtype_of<karst_teammate_t>();
template <>
py::dtype dtype_of<karst_ray_end_t>();
template <>
py::dtype dtype_of<karst_passage_t>();
template <>
py::dtype dtype_of<karst_passage_end_t>();
template <>
py::dtype dtype_of<karst_passage_place_t>();
template <>
py::dtype dtype_of<karst_surface_cell_t>();
template <>
py::dtype dtype_of<karst_survey_leg_t>();
template <>
py::dtype dtype_of<karst_survey_lead_t>();

/// A copy: numpy's array outlives the request.
template <class Struct>
py::array records(const Struct* data, std::size_t count) {
  return py::array(dtype_of<Struct>(), {static_cast<py::ssize_t>(count)}, data);
}
template <class Struct>
py::array records(const std::vector<Struct>& all) {
  return records(all.data(), all.size());
}

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Rows of an (n, 3) array; a (3,) array is one row. Throws Error naming `what` and the shape that came.
std::vector<Vec3> points_of(const Doubles& array, const std::string& what);
Vec3 point_of(const Doubles& array, const std::string& what);
/// Rows x, y, z, heading of an (n, 4) array; a (4,) array is one row.
std::vector<Viewpoint> viewpoints_of(const Doubles& array);

py::array_t<double> array_of(const Vec3& v);                 // (3,)
py::array_t<double> array_of(const std::vector<Vec3>& all);  // (n, 3)
py::array_t<double> array_of(const karst_quaternion_t& q);   // (4,): w, x, y, z

template <class Number>
py::array_t<Number> numbers(const std::vector<Number>& all) {
  return py::array_t<Number>(static_cast<py::ssize_t>(all.size()), all.data());
}

}  // namespace karst::python
