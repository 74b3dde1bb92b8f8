// karst._maps: OctoMap files as arrays.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_leaves.h"

namespace py = pybind11;

namespace {

/// (centres_m (n, 3) float64, sizes_m (n) float64, log_odds (n) float32, resolution_m).
py::tuple leaves_of(const std::string& path) {
  karst::core::MapLeaves map;
  {
    const py::gil_scoped_release others_may_run;
    map = karst::core::read_leaves(path);
  }
  const auto n = static_cast<py::ssize_t>(map.leaves.size());
  py::array_t<double> centres({n, py::ssize_t{3}}), sizes(n);
  py::array_t<float> log_odds(n);
  auto centre = centres.mutable_unchecked<2>();
  auto size = sizes.mutable_unchecked<1>();
  auto value = log_odds.mutable_unchecked<1>();
  py::ssize_t i = 0;
  for (const karst::core::MapLeaf& leaf : map.leaves) {
    const double middle = 0.5 * leaf.edge;  // cell k covers [k, k + 1) times the resolution
    centre(i, 0) = map.resolution_m * (leaf.low.x + middle);
    centre(i, 1) = map.resolution_m * (leaf.low.y + middle);
    centre(i, 2) = map.resolution_m * (leaf.low.z + middle);
    size(i) = map.resolution_m * leaf.edge;
    value(i++) = leaf.log_odds;
  }
  return py::make_tuple(centres, sizes, log_odds, map.resolution_m);
}

}  // namespace

PYBIND11_MODULE(_maps, m) {
  m.doc() = "OctoMap files (.ot, .bt) as arrays";
  py::register_local_exception<karst::core::InputError>(m, "InputError");
  m.def("read", &leaves_of, py::arg("path"),
        "centres_m (n, 3), sizes_m (n), log_odds (n) and resolution_m of the leaves of an OctoMap file. "
        "InputError names the file, the place and the reason.");
}
