#include "plugins/simulator/sensors/sensor_faults.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace karst::sim {

using Kind = cave::Fault::Kind;

namespace {

std::string in_words(const cave::Fault& fault) {
  char text[80];
  std::snprintf(text, sizeof text, "%s %s for %.3f s", core::name_of(fault.sensor), core::name_of(fault.kind),
                fault.lasts_s);
  return text;
}

}  // namespace

bool SensorFaults::InjectedFaults::lost() const {
  return std::find(kinds.begin(), kinds.end(), Kind::lost) != kinds.end();
}

SensorFaults::InjectedFaults SensorFaults::inject(cave::Fault::Sensor sensor, double t_s) {
  InjectedFaults injected;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const cave::Fault& f = faults_[i];
    if (f.sensor != sensor || t_s < f.after_s || (begun_[i] && t_s >= f.after_s + f.lasts_s)) continue;
    injected.kinds.push_back(f.kind);
    if (!begun_[i]) injected.begun.push_back(in_words(f));
    begun_[i] = true;
  }
  return injected;
}

void spoil(core::LidarScan& scan, Kind kind) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr core::TimeNs kOff = 250 * core::kMillisecond;
  if (kind == Kind::nan) {
    for (std::size_t i = 0; i < scan.range_m.size(); i += 2) scan.range_m[i] = kNan;
    for (std::size_t i = 0; i < scan.intensity.size(); i += 3) scan.intensity[i] = kNan;
  } else if (kind == Kind::three_points) {
    int left = 3;
    for (float& r : scan.range_m)
      if (!std::isfinite(r) || left-- <= 0) r = kNan;
  } else if (kind == Kind::stamp_back) {
    scan.stamp -= kOff;
  } else if (kind == Kind::stamp_ahead) {
    scan.stamp += kOff;
  }
}

}  // namespace karst::sim
