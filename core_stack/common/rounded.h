// Numbers as records hold them: no longer than they need to be.
#pragma once
#include <cmath>

namespace karst::core {

/// To the nearest multiple of 1 / `per_unit`. Zero has no sign: JSON would keep it, as "-0.0".
inline double rounded(double v, double per_unit) { return std::round(v * per_unit) / per_unit + 0.0; }

inline double to_hundredths(double v) { return rounded(v, 1e2); }
inline double to_thousandths(double v) { return rounded(v, 1e3); }
inline double to_millionths(double v) { return rounded(v, 1e6); }

}  // namespace karst::core
