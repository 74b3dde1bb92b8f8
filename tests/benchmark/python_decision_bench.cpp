// What a decision of my_nearest costs in Python and in C++, called through the same tables, in this process:
//
//   python_decision_bench lib/karst/languages/py.so my_nearest.py my_nearest.so
//
// Prints frontiers, and the medians in milliseconds. Both get the same requests, of frontiers within reach.
#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <vector>

#include <karst/testing/bench.h>

#include "sdk/abi/karst_abi_script.h"

namespace {

using namespace karst::testing;

template <class Function>
Function function_of(const char* file, const char* name) {
  void* const handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw karst::Error(dlerror());
  return reinterpret_cast<Function>(dlsym(handle, name));
}

std::vector<karst::Frontier> frontiers_of(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 100);
  std::vector<karst::Frontier> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    all[i].id = static_cast<std::uint32_t>(i + 1);
    all[i].cells = 20;
    all[i].viewpoint = {uniform(random), uniform(random), uniform(random)};
    all[i].path_length_m = uniform(random);
  }
  return all;
}

double decide_ms(Bench& bench, std::vector<std::uint32_t>& ids) {
  const auto from = std::chrono::steady_clock::now();
  const karst::Decision d = bench.decide();
  const auto until = std::chrono::steady_clock::now();
  ids.clear();
  for (const karst::Goal& g : d.goals) ids.push_back(g.frontier_id);
  return std::chrono::duration<double, std::milli>(until - from).count();
}

double median(std::vector<double> all) {
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return all[all.size() / 2];
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 1;
  try {
    const std::string file = arguments[2];
    karst_error_t error{};
    const karst_plugin_t* const python =
        function_of<karst_script_entry_fn>(arguments[1], KARST_SCRIPT_ENTRY_NAME)({file.data(), file.size()}, &error);
    if (python == nullptr) throw karst::Error(error.text);
    const karst_plugin_t* const twin =
        function_of<const karst_plugin_t* (*)()>(arguments[3], "karst_plugin_entry")();
    const DrawnMap map(1.0, {"#####\n#s.a#\n#####"});
    Bench in_python(python, map), in_cpp(twin, map);
    for (const std::size_t n : {10, 100, 1000, 4096}) {
      in_python.frontiers = in_cpp.frontiers = frontiers_of(n);
      std::vector<double> python_ms, cpp_ms;
      std::vector<std::uint32_t> a, b;
      for (int i = 0; i < 1000; ++i) {
        python_ms.push_back(decide_ms(in_python, a));
        cpp_ms.push_back(decide_ms(in_cpp, b));
        if (a != b) throw karst::Error("the answers differ");
      }
      std::printf("%5zu frontiers, %zu decisions each: Python %.3f ms, C++ %.3f ms\n", n, python_ms.size(),
                  median(python_ms), median(cpp_ms));
    }
    std::fflush(stdout);
    _Exit(0);  // Python is not finalized
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
