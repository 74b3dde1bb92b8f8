// The test bench over a map drawn by hand (karst/testing/bench.h), for policies in Python.
#pragma once
#include <pybind11/pybind11.h>

namespace karst::python {

void bind_bench(pybind11::module_& module);

}  // namespace karst::python
