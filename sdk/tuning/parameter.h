// A policy's numeric parameter as an axis of a search: from 0 to 1 over its declared range.
#pragma once
#include <string>
#include <vector>

#include "sdk/host/plugin/discovery.h"

namespace karst::tuning {

/// Maps a widely declared range to an axis. Steps on the axis are proportional to the value far above its
/// default, and constant near it: value = low + s ((1 + (high - low) / s)^u - 1), with s the distance of the
/// default from the lower bound.
struct Axis {
  std::string id, unit;
  double low = 0, high = 1, start = 0;  // start: the default
  bool whole = false;                   // a whole number

  double value(double u) const;
  double place(double value) const;  // the axis coordinate u of a value
  std::string text(double u) const;  // in a mission file's form: "7.25 m"; three digits, or whole
};

/// The axes of these parameters, or of all numeric ones if none is named. Throws InputError naming the policy
/// if a parameter does not exist, or none is a number.
std::vector<Axis> axes_of(const host::PolicyListing& policy, const std::vector<std::string>& ids);

}  // namespace karst::tuning
