// From a class in Python to the tables of the policy ABI.
#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include <karst/policy.h>

namespace karst::python {

namespace py = pybind11;

/// The plugin whose policies are these classes of Python, at most 64. It lives as long as the process; the
/// same classes give the same plugin. Throws Error if a class does not say what it is, or if the process has
/// no room for more (256 policies).
const karst_plugin_t* plugin_of(const std::vector<py::object>& classes);

/// A goal of Python (karst.Goal).
Goal goal_of(const py::handle& goal);

}  // namespace karst::python
