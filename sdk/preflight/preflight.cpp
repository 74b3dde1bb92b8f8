#include "sdk/preflight/preflight.h"

#include <algorithm>

namespace karst::preflight {

double expected_value(const PolicyFacts& policy, const std::string& metric) {
  const auto found = std::find_if(policy.expected.begin(), policy.expected.end(),
                                  [&](const ExpectedFigure& f) { return f.metric == metric; });
  return found == policy.expected.end() ? selection::kUnknown : found->value;
}

}  // namespace karst::preflight
