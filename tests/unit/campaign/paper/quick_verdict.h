// A verdict for tests: of few resamples, and without a forecast.
#pragma once
#include "sdk/campaign/verdict/verdict.h"

namespace karst::test {

inline campaign::VerdictOptions quick_verdict() {
  campaign::VerdictOptions options;
  options.resamples = 400;
  options.simulations = 0;
  return options;
}

}  // namespace karst::test
