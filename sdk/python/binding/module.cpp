// karst._karst: what of the module karst is in C++.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "sdk/python/binding/drawn_bench.h"
#include "sdk/python/binding/policy_table.h"
#include "sdk/python/binding/services.h"

namespace py = pybind11;

PYBIND11_MODULE(_karst, module) {
  module.attr("version") = KARST_VERSION;
  module.attr("abi") = std::to_string(KARST_ABI_MAJOR) + "." + std::to_string(KARST_ABI_MINOR);
  // The text of karst::Error is for karst.Error, so that a policy can catch it.
  // Never freed: at the end of the process there is no Python to do so.
  static const py::object& error = *new py::object(py::module_::import("karst.errors").attr("Error"));
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const karst::Error& e) {
      PyErr_SetString(error.ptr(), e.what());
    }
  });
  karst::python::bind_services(module);
  karst::python::bind_bench(module);
  module.def("plugin_of", [](const std::vector<py::object>& classes) {
    return py::capsule(karst::python::plugin_of(classes), "karst_plugin_t");
  });
}
