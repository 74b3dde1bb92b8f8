#include "core_stack/mission/decision/goal_ledger.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr double kSamePlace_m = 0.8;
constexpr double kMapRadius_m = 1.5;
constexpr double kFirstPause_s = 10.0;
constexpr int kMaxDoublings = 6;
constexpr TimeNs kShortPause = 2 * kSecond;
constexpr int kMaxPauses = 4;

}  // namespace

GoalLedger::Entry& GoalLedger::entry_of(const Vec3& place) {
  const auto same = [&](const Entry& e) { return (e.place - place).norm() < kSamePlace_m; };
  const auto entry = std::find_if(entries_.begin(), entries_.end(), same);
  return entry != entries_.end() ? *entry : entries_.emplace_back(Entry{place, std::nullopt, 0, 0, 0, ""});
}

void GoalLedger::close(const VoxelMap& map, const Vec3& place, TimeNs now, const std::string& why) {
  Entry& entry = entry_of(place);
  const double pause_s = kFirstPause_s * (1 << std::min(entry.attempts, kMaxDoublings));
  entry.revision = map.revision_near(place, kMapRadius_m);
  entry.closed_until = now + from_seconds(pause_s);
  entry.attempts += 1;
  entry.why = why;
}

void GoalLedger::pause(const VoxelMap& map, const Vec3& place, TimeNs now, const std::string& why) {
  Entry& entry = entry_of(place);
  if (++entry.pauses > kMaxPauses) return close(map, place, now, why);
  entry.revision.reset();
  entry.closed_until = now + kShortPause;
  entry.why = why;
}

std::optional<std::string> GoalLedger::closed(const VoxelMap& map, const Vec3& place,
                                              const ClosureRules& rules) const {
  for (const Entry& e : entries_) {
    if ((e.place - place).norm() >= kSamePlace_m) continue;
    const bool unchanged =
        !rules.ignore_map_change && e.revision && map.revision_near(e.place, kMapRadius_m) == *e.revision;
    if (rules.at < e.closed_until || unchanged) return e.why;
  }
  return std::nullopt;
}

}  // namespace karst::core
