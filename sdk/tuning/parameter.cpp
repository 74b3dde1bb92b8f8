#include "sdk/tuning/parameter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core_stack/common/error.h"
#include "core_stack/common/former_keys.h"
#include "core_stack/common/options.h"

namespace karst::tuning {
namespace {

double scale_of(const Axis& a) {
  const double range = a.high - a.low;
  return a.start > a.low ? std::max(a.start - a.low, range / 1000) : range / 20;
}

}  // namespace

double Axis::value(double u) const {
  const double s = scale_of(*this);
  return std::clamp(low + s * (std::pow(1 + (high - low) / s, std::clamp(u, 0.0, 1.0)) - 1), low, high);
}

double Axis::place(double v) const {
  const double s = scale_of(*this);
  return std::log1p((v - low) / s) / std::log1p((high - low) / s);
}

std::string Axis::text(double u) const {
  std::array<char, 32> number;
  const bool as_declared = std::abs(value(u) - start) < 1e-9 * (high - low);
  std::snprintf(number.data(), number.size(),
                whole         ? "%.0f"
                : as_declared ? "%.9g"
                              : "%.3g",
                as_declared ? start : value(u));
  // Rounding to three digits may exceed a bound.
  if (!whole && (std::atof(number.data()) > high || std::atof(number.data()) < low))
    std::snprintf(number.data(), number.size(), "%.17g", value(u));
  return number.data() + (unit.empty() ? "" : " " + unit);
}

std::vector<Axis> axes_of(const host::PolicyListing& policy, const std::vector<std::string>& ids) {
  std::vector<Axis> axes;
  std::vector<std::string> names;
  for (const host::ParameterListing& p : policy.parameters) {
    const bool number = p.type == host::ParameterType::real || p.type == host::ParameterType::integer;
    const bool wanted = ids.empty() || std::find(ids.begin(), ids.end(), p.id) != ids.end();
    if (number) names.push_back(p.id);
    if (!wanted) continue;
    if (!number && !ids.empty()) throw core::InputError(policy.id, p.id, "is no number: it cannot be tuned");
    if (number && p.high > p.low)
      axes.push_back({p.id, p.unit, p.low, p.high, std::strtod(p.default_text.c_str(), nullptr),
                      p.type == host::ParameterType::integer});
  }
  for (const std::string& id : ids)
    if (std::none_of(axes.begin(), axes.end(), [&](const Axis& a) { return a.id == id; })) {
      if (const std::string now = core::renamed(id);
          std::find(names.begin(), names.end(), now) != names.end())
        throw core::InputError(policy.id, id, "is now called " + now);
      const std::string near = core::nearest_name(id, names);
      throw core::InputError(policy.id, id,
                             "no such parameter" + (near.empty() ? "" : "; did you mean " + near + "?"));
    }
  if (axes.empty()) throw core::InputError(policy.id, "", "has no parameter that is a number");
  return axes;
}

}  // namespace karst::tuning
