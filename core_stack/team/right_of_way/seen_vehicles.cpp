#include "core_stack/team/right_of_way/seen_vehicles.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr TimeNs kHistory = kSecond;            // of sightings
constexpr TimeNs kVelocityOver = kSecond / 2;   // a sighting's middle is off by some centimetres
constexpr TimeNs kLostMoving = 3 * kSecond;     // then it may be anywhere
constexpr TimeNs kLostStanding = 10 * kSecond;  // once it is in the map it is not seen anew
constexpr double kSame_m = 0.6;                 // from where it should be
constexpr double kFastest_mps = 4.0;
constexpr double kFlies_m = 0.3;
constexpr double kStands_m = 0.25, kStands_mps = 0.25;
// What flies keeps to a line for half a second; what noise and dust show jumps about.
constexpr std::size_t kFewestSightings = 5;
constexpr TimeNs kSeenFor = 4 * kSecond / 10;  // from the first of five to the last, at 10 Hz
// One that is fast is sooner known from noise, and there is less time.
constexpr std::size_t kFewestOfFast = 3;
constexpr TimeNs kFastSeenFor = 2 * kSecond / 10;
constexpr double kFast_mps = 1.0, kFastOffLine_m = 0.05;
constexpr std::size_t kMaxTracks = 32;
constexpr double kOffLine_m = 0.12;  // root mean square
constexpr double kHeard_m = 1.5;     // from where one that is heard should be
constexpr int kFirstNumber = kMaxRobots, kNumbers = 256 - kMaxRobots;

}  // namespace

/// Over the last half second, or longer if it was hidden; zero if it was seen only once.
Vec3 SeenVehicles::Track::velocity_mps() const {
  const Sighting& last = sightings.back();
  const Sighting* from = &sightings.front();
  for (const Sighting& s : sightings)
    if (s.stamp <= last.stamp - kVelocityOver) from = &s;
  const double passed_s = seconds(last.stamp - from->stamp);
  if (passed_s < 0.15) return Vec3::Zero();
  return (last.position - from->position) / passed_s;
}

bool SeenVehicles::Track::stands(TimeNs now) const {
  const Sighting &last = sightings.back(), &first = sightings.front();
  if (now - last.stamp > kHistory) return sightings.size() > 1 && velocity_mps().norm() < kStands_mps;
  return last.stamp - first.stamp > kHistory * 3 / 4 &&
         std::all_of(sightings.begin(), sightings.end(),
                     [&](const Sighting& s) { return (s.position - last.position).norm() < kStands_m; });
}

bool SeenVehicles::Track::forgotten(TimeNs now) const {
  return now - sightings.back().stamp > (flies && stands(now) ? kLostStanding : kLostMoving);
}

/// By a least-squares line through place over time.
bool SeenVehicles::Track::moves_steadily() const {
  const TimeNs seen_for = sightings.back().stamp - sightings.front().stamp;
  if (sightings.size() < kFewestOfFast || seen_for < kFastSeenFor) return false;
  const auto n = static_cast<double>(sightings.size());
  double mean_t = 0, var_t = 0;
  Vec3 mean = Vec3::Zero(), cov = Vec3::Zero();
  const TimeNs begin = sightings.front().stamp;
  for (const Sighting& s : sightings) {
    mean_t += seconds(s.stamp - begin) / n;
    mean += s.position / n;
  }
  for (const Sighting& s : sightings) {
    const double t = seconds(s.stamp - begin) - mean_t;
    var_t += t * t;
    cov += t * (s.position - mean);
  }
  if (var_t <= 0) return false;
  const Vec3 v = cov / var_t;
  double off2 = 0;
  for (const Sighting& s : sightings)
    off2 += (s.position - mean - (seconds(s.stamp - begin) - mean_t) * v).squaredNorm() / n;
  const double speed_mps = v.norm();
  if (speed_mps * seconds(seen_for) < kFlies_m || speed_mps > kFastest_mps) return false;
  if (sightings.size() < kFewestSightings || seen_for < kSeenFor)
    return speed_mps > kFast_mps && off2 < kFastOffLine_m * kFastOffLine_m;
  return off2 < kOffLine_m * kOffLine_m;
}

SeenVehicles::Track* SeenVehicles::same_as(const Vec3& position, TimeNs stamp) {
  Track* best = nullptr;
  double best_m = kSame_m;
  for (Track& t : tracks_) {
    const Sighting& last = t.sightings.back();
    const double passed_s = seconds(stamp - last.stamp);
    if (passed_s <= 0) continue;  // another body of the same scan, or a scan that comes late
    const Vec3 v = t.velocity_mps();
    const double off_m = (last.position + passed_s * v - position).norm();
    if (off_m >= best_m) continue;
    best = &t;
    best_m = off_m;
  }
  return best;
}

void SeenVehicles::note(std::span<const Vec3> bodies, TimeNs stamp, std::span<const Neighbour> heard) {
  const auto is_heard = [&](const Vec3& body) {
    return std::any_of(heard.begin(), heard.end(),
                       [&](const Neighbour& h) { return (h.position - body).norm() < kHeard_m; });
  };
  std::erase_if(tracks_,
                [&](const Track& t) { return t.forgotten(stamp) || is_heard(t.sightings.back().position); });
  for (const Vec3& body : bodies) {
    if (is_heard(body)) continue;
    Track* track = same_as(body, stamp);
    if (!track) {
      if (tracks_.size() == kMaxTracks) continue;
      track = &tracks_.emplace_back();
    }
    std::deque<Sighting>& sightings = track->sightings;
    sightings.push_back({stamp, body});
    while (sightings.size() > 2 && sightings.front().stamp < stamp - kHistory) sightings.pop_front();
    if (track->flies || !track->moves_steadily()) continue;
    track->flies = true;
    track->number = static_cast<RobotId>(kFirstNumber + begun_++ % kNumbers);
  }
}

std::vector<Neighbour> SeenVehicles::neighbours(TimeNs now) const {
  std::vector<Neighbour> out;
  for (const Track& t : tracks_) {
    if (!t.flies || t.forgotten(now)) continue;
    const Sighting& last = t.sightings.back();
    const double age_s = std::max(0.0, seconds(now - last.stamp));
    if (t.stands(now)) {
      out.push_back({t.number, last.position, Vec3::Zero(), TeamPhase::aside, age_s, false});
    } else {
      const Vec3 v = t.velocity_mps();
      out.push_back({t.number, last.position + age_s * v, v, TeamPhase::landing, age_s, false});
    }
  }
  return out;
}

}  // namespace karst::core
