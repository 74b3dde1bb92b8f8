#include "plugins/simulator/simulated_team.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/environment/object_placing.h"

namespace karst::sim {

using core::InputError;
using core::TimeNs;
using core::Vec3;

namespace {

constexpr TimeNs kLogPeriod = 5 * core::kSecond;

/// Whether a vehicle can stand on the floor there, without a pad, and climb.
bool fits(const cave::Cave& cave, const cave::StartPose& start, double radius_m, double climb_m) {
  constexpr double kAround_m = 0.3;
  if (cave.scene.distance_to_rock(start.position, 5.0) < radius_m + kAround_m) return false;
  cave::Cave own = cave;
  own.description.start = start;
  const LaunchSite site = set_down(own, radius_m);
  if (site.pad) return false;
  try {
    cave::check_climb(own, site.T_world_start.position, climb_m, radius_m);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

bool in_sight(const cave::RayScene& scene, const Vec3& a, const Vec3& b) {
  const double d = (b - a).norm();
  return scene.ray_cast(a, b - a, d) >= d;
}

cave::Cave cave_for_team(const ObjectOptions& objects, const core::VehicleSetup& setup) {
  cave::Cave cave = cave::load_cave(setup.cave, setup.start, setup.mesh);
  for (const cave::LooseRock& rock : cave.description.boulders)
    if (rock.within_m > 0)
      throw InputError(cave.description.file, "boulder.within",
                       "a boulder that waits for a vehicle to come near cannot be flown by a team: it would "
                       "fall for each vehicle alone");
  place_objects(cave, objects, setup.seed);
  return cave;
}

}  // namespace

std::vector<cave::StartPose> start_places(const cave::Cave& cave, std::size_t n, double radius_m,
                                          double climb_m, double apart_m) {
  const cave::StartPose& first = cave.description.start;
  std::vector<cave::StartPose> places{first};
  constexpr int kRings = 8, kRingStep = 8;
  for (int ring = 1; ring <= kRings && places.size() < n; ++ring)
    for (int k = 0; k < kRingStep * ring && places.size() < n; ++k) {
      const double angle = first.heading_rad + 2 * std::numbers::pi * k / (kRingStep * ring);
      cave::StartPose p = first;
      p.position += apart_m * ring * Vec3(std::cos(angle), std::sin(angle), 0);
      const bool apart = std::all_of(places.begin(), places.end(), [&](const cave::StartPose& o) {
        return (o.position - p.position).norm() >= apart_m - 1e-9;
      });
      if (apart && in_sight(cave.scene, first.position, p.position) && fits(cave, p, radius_m, climb_m))
        places.push_back(p);
    }
  if (places.size() < n)
    throw InputError(cave.description.file, "start",
                     "around it there is room for " + std::to_string(places.size()) +
                         " vehicles side by side, not for " + std::to_string(n));
  return places;
}

bool touched(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1, double distance_m) {
  const Vec3 from = a0 - b0, offset = (a1 - b1) - from;  // of a relative to b
  const double length2 = offset.squaredNorm();
  const double t = length2 > 0 ? std::clamp(-from.dot(offset) / length2, 0.0, 1.0) : 0.0;
  return (from + t * offset).norm() < distance_m;
}

std::optional<Vec3> fallen(const cave::RayScene& scene, const Vec3& from, const Vec3& velocity_mps) {
  constexpr double kStep_s = 0.02, kLongest_s = 20.0, kAbove_m = 0.1, kMast_m = 0.2;
  Vec3 at = from, velocity = velocity_mps;
  for (double t = 0; t < kLongest_s; t += kStep_s) {
    velocity.z() -= kGravity_mps2 * kStep_s;
    const Vec3 step = velocity * kStep_s;
    const double length_m = step.norm(), free_m = scene.ray_cast(at, step / length_m, length_m + kAbove_m);
    if (free_m < length_m + kAbove_m)
      return Vec3(at + step / length_m * (free_m - kAbove_m) + Vec3(0, 0, kMast_m));
    at += step;
  }
  return std::nullopt;
}

SimulatedTeam::SimulatedTeam(const SimulatorOptions& options, const RadioOptions& radio,
                             const WorldSetup& setup)
    : radius_m_(options.body.radius_m),
      cave_(cave_for_team(options.objects, setup.world)),
      starts_(start_places(cave_, setup.seeds.size(), radius_m_, setup.world.climb_m)),
      radio_(radio, setup.world.seed) {
  radio_.place(0, base());
  for (std::size_t i = 0; i < setup.seeds.size(); ++i) {
    core::VehicleSetup own = setup.world;
    own.run_dir = setup.run_dirs[i];
    own.seed = setup.seeds[i];
    cave::Cave cave = cave_;
    cave.description.start = starts_[i];
    robots_.push_back(std::make_unique<SimulatedVehicle>(options, own, cave, setup.starts_after_s[i]));
    last_.push_back(robots_.back()->position());
  }
  if (!setup.world.run_dir.empty()) {
    truth_file_ = setup.world.run_dir + "/team_truth.jsonl";
    truth_.open(truth_file_, std::ios::binary);
    if (!truth_) throw InputError(truth_file_, "", "cannot be written");
  }
  meet(0);
}

std::string SimulatedTeam::start_of(std::size_t i) const {
  const cave::StartPose& s = starts_.at(i);
  char text[120];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g %.17g", s.position.x(), s.position.y(), s.position.z(),
                s.heading_rad * 180 / std::numbers::pi);
  return text;
}

void SimulatedTeam::meet(TimeNs now) {
  count_contacts(now);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    last_[i] = robots_[i]->position();
    radio_.place(static_cast<int>(i) + 1, last_[i]);
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    std::vector<cave::Sphere> others;
    for (std::size_t k = 0; k < robots_.size(); ++k)
      if (k != i) others.push_back({last_[k], radius_m_});
    robots_[i]->see(std::move(others));
  }
  if (now % kLogPeriod == 0) log(now);
}

void SimulatedTeam::count_contacts(TimeNs now) {
  for (std::size_t i = 0; i < robots_.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const bool a = robots_[i]->airborne(), b = robots_[k]->airborne();
      if ((!a && !b) ||
          !touched(last_[i], robots_[i]->position(), last_[k], robots_[k]->position(), 2 * radius_m_))
        continue;
      char text[160];
      std::snprintf(text, sizeof text, "{\"t\":%.1f,\"kind\":\"contact\",\"robots\":[%zu,%zu]}\n",
                    core::seconds(now), k + 1, i + 1);
      if (truth_.is_open()) truth_ << text;
      if (a) robots_[i]->end_flight(core::MissionOutcome::contact, "touched robot " + std::to_string(k + 1));
      if (b) robots_[k]->end_flight(core::MissionOutcome::contact, "touched robot " + std::to_string(i + 1));
    }
}

/// A node that falls through a hole in the mesh has its radio switched off.
void SimulatedTeam::drop_node(std::size_t robot, std::size_t radio) {
  const SimulatedVehicle& from = *robots_.at(robot);
  const std::optional<Vec3> place = fallen(cave_.scene, from.position(), from.velocity_mps());
  radio_.place(static_cast<int>(radio), place.value_or(from.position()));
  if (!place) return silence(radio);
  nodes_.push_back({static_cast<int>(radio), *place});
}

/// Logs positions and the pairs of radios in range of each other, without fading or random loss.
void SimulatedTeam::log(TimeNs now) {
  if (!truth_.is_open()) return;
  char text[120];
  std::snprintf(text, sizeof text, "{\"t\":%.1f,\"kind\":\"radio\",\"positions\":[", core::seconds(now));
  truth_ << text;
  const auto place = [&](const Vec3& p, const char* before) {
    std::snprintf(text, sizeof text, "%s[%.2f,%.2f,%.2f]", before, p.x(), p.y(), p.z());
    truth_ << text;
  };
  place(base(), "");
  for (const Vec3& p : last_) place(p, ",");
  truth_ << "],\"links\":[";
  std::vector<int> radios(robots_.size() + 1);
  std::iota(radios.begin(), radios.end(), 0);
  for (const Node& n : nodes_) radios.push_back(n.radio);
  const char* before = "";
  for (std::size_t a = 0; a < radios.size(); ++a)
    for (std::size_t b = a + 1; b < radios.size(); ++b)
      if (radio_.margin_db(cave_.scene, radios[a], radios[b]) >= 0) {
        truth_ << before << '[' << radios[a] << ',' << radios[b] << ']';
        before = ",";
      }
  truth_ << ']';
  for (const Node& n : nodes_) {
    truth_ << (&n == &nodes_.front() ? ",\"nodes\":[[" : ",[") << n.radio;
    place(n.position, ",");
    truth_ << ']';
  }
  truth_ << (nodes_.empty() ? "}\n" : "]}\n");
  truth_.flush();
}

void SimulatedTeam::wreck(std::size_t robot, const std::string& reason) {
  silence(robot + 1);
  if (robots_.at(robot)->airborne()) robots_[robot]->end_flight(core::MissionOutcome::lost, reason);
}

SimulatedTeam::Port& SimulatedTeam::port_of(std::size_t radio) {
  return ports_.try_emplace(radio, *this, radio).first->second;
}

void SimulatedTeam::Port::send(std::span<const std::uint8_t> frame, TimeNs now) {
  team_.radio_.send(team_.cave_.scene, static_cast<int>(radio_), frame, now);
}

std::vector<std::vector<std::uint8_t>> SimulatedTeam::Port::receive(TimeNs until) {
  std::vector<std::vector<std::uint8_t>> out;
  for (RadioPacket& p : team_.radio_.receive(static_cast<int>(radio_), until))
    out.push_back(std::move(p.bytes));
  return out;
}

RadioTraffic SimulatedTeam::traffic(std::size_t radio) const {
  const RadioCounts& c = radio_.counts(static_cast<int>(radio));
  return {c.bytes_sent, c.bytes_dropped, c.bytes_heard,   c.bytes_lost,
          c.bytes_weak, c.packets_sent,  c.packets_heard, c.packets_corrupted};
}

void SimulatedTeam::finish() {
  if (!truth_.is_open()) return;
  truth_.close();
  if (!truth_) throw InputError(truth_file_, "", "could not be written whole: is the disk full?");
}

}  // namespace karst::sim
