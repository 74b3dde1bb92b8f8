// Processor times of repeated work and how they are printed. Processor time, so that other work on the
// machine counts little.
#pragma once
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace karst::core::bench {

template <class F>
double cpu_ms(F&& f) {
  const std::clock_t begin = std::clock();
  f();
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

struct Times {
  std::vector<double> ms;
  double at(double fraction) {
    std::sort(ms.begin(), ms.end());
    return ms[std::min(ms.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(ms.size())))];
  }
  double mean() const {
    double sum = 0;
    for (const double v : ms) sum += v;
    return sum / static_cast<double>(ms.size());
  }
  void print(const char* what) {
    if (ms.empty()) return;
    std::printf("  %-44s p50 %8.2f  p99 %8.2f  max %8.2f  mean %8.3f ms  (%zu)\n", what, at(0.5), at(0.99),
                at(1.0), mean(), ms.size());
  }
};

}  // namespace karst::core::bench
