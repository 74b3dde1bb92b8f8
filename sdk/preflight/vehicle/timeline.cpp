#include "sdk/preflight/vehicle/timeline.h"

#include <cmath>

#include "sdk/preflight/vehicle/median.h"

namespace karst::preflight {
namespace {

/// A single late message is no jump: the medians of as many before and after it are compared.
constexpr std::size_t kLasting = 5;

/// The greatest difference between the medians of the latency after and before a message.
double jump_of(const std::vector<double>& latency_s) {
  double jump = 0;
  for (std::size_t i = kLasting; i + kLasting <= latency_s.size(); ++i) {
    const auto at = latency_s.begin() + static_cast<std::ptrdiff_t>(i);
    const double change = median({at, at + kLasting}) - median({at - kLasting, at});
    if (std::abs(change) > std::abs(jump)) jump = change;
  }
  return jump;
}

}  // namespace

Timeline timeline_of(std::span<const Arrival> arrivals, core::TimeNs begin, core::TimeNs end) {
  Timeline t;
  t.per_second.assign(static_cast<std::size_t>(std::max<core::TimeNs>(0, (end - begin) / core::kSecond)), 0);
  std::vector<double> latency_s, interval_s;
  const Arrival* last = nullptr;
  core::TimeNs first = end;
  for (const Arrival& a : arrivals) {
    if (a.came < begin || a.came > end) continue;
    if (!last) first = a.came;
    ++t.messages;
    if (const auto s = static_cast<std::size_t>((a.came - begin) / core::kSecond); s < t.per_second.size())
      ++t.per_second[s];
    latency_s.push_back(core::seconds(a.came - a.stamp));
    t.future_s = std::max(t.future_s, -latency_s.back());
    if (last) {
      t.longest_gap_s = std::max(t.longest_gap_s, core::seconds(a.came - last->came));
      interval_s.push_back(core::seconds(a.stamp - last->stamp));
      if (a.stamp <= last->stamp) ++t.backward;
    }
    last = &a;
  }
  t.first_after_s = core::seconds(first - begin);
  if (!last) return t;
  t.longest_gap_s = std::max(t.longest_gap_s, core::seconds(end - last->came));
  // Up to the last message, or to the end if it is overdue: then the sensor fell silent.
  core::TimeNs span = last->came - first;
  if (t.messages < 2 || end - last->came > 2 * span / (t.messages - 1)) span = end - first;
  if (span > 0) t.rate_hz = (t.messages - 1) / core::seconds(span);
  t.latency_s = median(latency_s);
  t.jump_s = jump_of(latency_s);
  const double usual_s = median(interval_s);
  for (double& i : interval_s) i = std::abs(i - usual_s);
  if (!interval_s.empty()) t.jitter_s = quantile(interval_s, 0.95);
  return t;
}

}  // namespace karst::preflight
