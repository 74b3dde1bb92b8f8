#include "tests/unit/evaluation/fake_run.h"

#include <stdlib.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::test {
namespace {

using core::CellKey;
using core::Vec3;
using nlohmann::json;

constexpr double kTakeoffHeight_m = 0.8;
constexpr double kVertical_mps = 0.4;
constexpr double kPeriod_s = 0.1;
constexpr double kView_m = 10;
constexpr double kDecision_s = 4;

struct Moment {
  double t_s, s_m;  // time, and place along the tunnel
  const char* phase;
  Vec3 position, velocity;
};

Vec3 floor_lift() { return Vec3(0, 0, -kTakeoffHeight_m); }

std::vector<Moment> fly(const FakeRunOptions& o) {
  std::vector<Moment> flight;
  const double far = o.length_m - 6, vertical_s = kTakeoffHeight_m / kVertical_mps, leg_s = far / o.speed_mps;
  const auto add = [&](double t, double s, const char* phase, double lift) {
    Moment m{t, s, phase, tunnel_centre(s) + floor_lift() * lift, Vec3::Zero()};
    if (!flight.empty()) m.velocity = (m.position - flight.back().position) / (t - flight.back().t_s);
    flight.push_back(m);
  };
  const int steps = static_cast<int>((2 * vertical_s + 2 * leg_s) / kPeriod_s);
  for (int i = 0; i <= steps; ++i) {
    const double t = i * kPeriod_s;
    if (t < vertical_s) {
      add(t, 0, "takeoff", 1 - t / vertical_s);
    } else if (t < vertical_s + leg_s) {
      add(t, (t - vertical_s) * o.speed_mps, "explore", 0);
    } else if (t < vertical_s + 2 * leg_s) {
      add(t, far - (t - vertical_s - leg_s) * o.speed_mps, "home", 0);
    } else {
      add(t, 0, "land", (t - vertical_s - 2 * leg_s) / vertical_s);
    }
  }
  return flight;
}

/// First sight of each wall cell: when the vehicle is within view of it.
std::map<CellKey, double> wall_cells(const FakeRunOptions& o, const std::vector<Moment>& flight) {
  std::map<CellKey, double> cells;
  std::size_t at = 0;
  const double cell = o.map_resolution_m;
  for (double s = -3; s < o.length_m; s += cell / 2) {
    while (at + 1 < flight.size() && flight[at].s_m + kView_m < s) ++at;
    const int around = static_cast<int>(4 * std::numbers::pi * tunnel_radius(s) / cell);
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      const double r = tunnel_radius(s) + 0.25 * std::sin(5 * a + s) + 0.2 * std::sin(2.3 * s - 3 * a);
      const Vec3 p = tunnel_centre(s) + r * Vec3(0, std::cos(a), std::max(-0.55, std::sin(a)));
      const auto key = [&](double v) { return static_cast<std::int32_t>(std::floor(v / cell)); };
      cells.emplace(CellKey{key(p.x()), key(p.y()), key(p.z())}, flight[at].t_s);
    }
  }
  return cells;
}

void write_growth(const std::filesystem::path& file, const std::map<CellKey, double>& cells) {
  std::multimap<std::int32_t, CellKey> by_time;
  for (const auto& [key, t_s] : cells)
    by_time.emplace(static_cast<std::int32_t>(std::lround(t_s * 1000)), key);
  std::ofstream out(file, std::ios::binary);
  for (const auto& [t_ms, k] : by_time) {
    const std::int32_t record[4] = {k.x, k.y, k.z, t_ms};
    out.write(reinterpret_cast<const char*>(record), sizeof record);
  }
}

json array_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void write_decision(std::ostream& out, const Moment& m, int n, const FakeRunOptions& o) {
  const double ahead = std::min(m.s_m + 7, o.length_m - 6);
  json clusters = json::array(), tour = json::array(), rays = json::array();
  for (int i = 0; i < 12; ++i) {
    const double a = i * 0.52, r = 0.7 * tunnel_radius(m.s_m + kView_m);
    const Vec3 p = tunnel_centre(m.s_m + kView_m) + r * Vec3(0, std::cos(a), 0.5 * std::sin(a));
    clusters.push_back({100 + i, p.x(), p.y(), p.z(), 20 + 25 * (i % 5)});
    rays.push_back(array_of(tunnel_centre(ahead)));
    rays.push_back(array_of(p));
  }
  for (double s = m.s_m; s <= ahead; s += 1) tour.push_back(array_of(tunnel_centre(s)));
  const auto emit = [&](json e) { out << e.dump() << "\n"; };
  const bool refused = n % 6 == 4;
  emit({{"t", m.t_s}, {"kind", "frontiers"}, {"clusters", clusters}});
  emit({{"t", m.t_s},
        {"kind", "decision"},
        {"sequence", n},
        {"outcome", "goals"},
        {"goals", 3},
        {"reason", ""},
        {"frontiers", clusters.size()}});
  emit({{"t", m.t_s},
        {"kind", "drawing"},
        {"shape", "lines"},
        {"rgb", 0x56b4e9},
        {"text", ""},
        {"points", rays}});
  emit({{"t", m.t_s},
        {"kind", "drawing"},
        {"shape", "text"},
        {"rgb", 0xffffff},
        {"text", "gain 412 cells"},
        {"points", {array_of(tunnel_centre(m.s_m + kView_m) + Vec3(0, 0, 2))}}});
  if (refused)
    emit({{"t", m.t_s},
          {"kind", "goal"},
          {"position", array_of(tunnel_centre(ahead + 9))},
          {"heading", nullptr},
          {"frontier", 103},
          {"score", 9.1},
          {"why", "largest opening"},
          {"state", "rejected"},
          {"reason", "not in known free space"}});
  emit({{"t", m.t_s},
        {"kind", "goal"},
        {"position", array_of(tunnel_centre(ahead))},
        {"heading", 0.1},
        {"frontier", 100},
        {"score", 7.25 - 0.1 * n},
        {"why", "nearest to the direction of flight: 4 deg off, 7 m away"},
        {"state", "accepted"},
        {"reason", ""}});
  emit({{"t", m.t_s},
        {"kind", "plan"},
        {"length", ahead - m.s_m},
        {"from", tour.front()},
        {"to", tour.back()},
        {"points", tour}});
  emit({{"t", m.t_s + kDecision_s - 0.05},
        {"kind", "goal"},
        {"position", array_of(tunnel_centre(ahead))},
        {"heading", 0.1},
        {"frontier", 100},
        {"score", 7.25},
        {"why", "nearest to the direction of flight"},
        {"state", n % 3 == 0 ? "superseded" : "reached"},
        {"reason", ""}});
}

void write_events(const std::filesystem::path& file, const std::vector<Moment>& flight,
                  const FakeRunOptions& o) {
  std::ofstream out(file);
  std::string phase;
  double next_decision_s = 0;
  int n = 0;
  for (const Moment& m : flight) {
    if (phase != m.phase) {
      phase = m.phase;
      out << json({{"t", m.t_s}, {"kind", "phase"}, {"phase", phase}}).dump() << "\n";
      if (phase == "home")
        out << json({{"t", m.t_s},
                     {"kind", "homing"},
                     {"reason", "explored"},
                     {"distance", m.s_m},
                     {"seconds_left", 300.0}})
                   .dump()
            << "\n";
    }
    if (phase == "explore" && m.t_s >= next_decision_s) {
      write_decision(out, m, ++n, o);
      next_decision_s = m.t_s + kDecision_s;
    }
  }
  const double end = flight.back().t_s;
  out << json({{"t", end}, {"kind", "phase"}, {"phase", "done"}}).dump() << "\n";
  out << json({{"t", end}, {"kind", "outcome"}, {"outcome", "landed"}, {"reason", "explored"}}).dump()
      << "\n";
}

void write_tables(const std::filesystem::path& dir, const std::vector<Moment>& flight,
                  const FakeRunOptions& o) {
  std::ofstream telemetry(dir / "telemetry.csv"), truth(dir / "truth.csv"), decisions(dir / "decisions.csv");
  std::ofstream estimate(dir / "trajectory.tum"), ground_truth(dir / "ground_truth.tum");
  telemetry << "t_s,phase,x,y,z,vx,vy,vz,heading_rad,ref_x,ref_y,ref_z,battery_fraction,seconds_left,"
               "explored_m3,home_distance_m\n";
  truth << "t_s,clearance_m,speed_mps\n";
  decisions << "t_s,decide_ms,plan_ms\n";
  core::Random random(7);
  double farthest = 0, flown = 0, next_decision_s = 0;
  char line[400];
  for (std::size_t i = 0; i < flight.size(); ++i) {
    const Moment& m = flight[i];
    if (i > 0) flown += (m.position - flight[i - 1].position).norm();
    farthest = std::max(farthest, m.s_m);
    const Vec3 estimated = m.position + Vec3(o.drift_per_m * flown, 0, 0);
    const double heading = std::atan2(m.velocity.y(), m.velocity.x() + 1e-9);
    std::snprintf(line, sizeof line,
                  "%.1f,%s,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.5f,%.1f,%.2f,%.2f\n", m.t_s,
                  m.phase, estimated.x(), estimated.y(), estimated.z(), m.velocity.x(), m.velocity.y(),
                  m.velocity.z(), heading, m.position.x(), m.position.y(), m.position.z(), 1 - m.t_s / 600,
                  600 - m.t_s, 28.0 * (farthest + kView_m), m.s_m);
    telemetry << line;
    std::snprintf(line, sizeof line, "%.1f,%.4f,%.4f\n", m.t_s,
                  tunnel_radius(m.s_m) - 0.5 - 0.3 * random.uniform(), m.velocity.norm());
    truth << line;
    const auto tum = [&](std::ostream& out, const Vec3& p) {
      const core::Quat q = core::from_heading(heading);
      std::snprintf(line, sizeof line, "%.3f %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n", m.t_s, p.x(), p.y(),
                    p.z(), q.x(), q.y(), q.z(), q.w());
      out << line;
    };
    tum(estimate, estimated);
    tum(ground_truth, m.position);
    if (std::string(m.phase) == "explore" && m.t_s >= next_decision_s) {
      next_decision_s = m.t_s + kDecision_s;
      std::snprintf(line, sizeof line, "%.1f,%.3f,%.3f\n", m.t_s,
                    0.3 + 8 * random.uniform() * random.uniform(), 2 + 30 * random.uniform());
      decisions << line;
    }
  }
}

}  // namespace

Vec3 tunnel_centre(double s) {
  return {s, 14 * (1 - std::cos(s / 28)), 4 * std::sin(s / 37) - 1.2 * std::sin(s / 11)};
}
double tunnel_radius(double s) {
  return 2.6 + 0.8 * std::sin(s / 9) + 2.5 * std::exp(-std::pow((s - 45) / 9, 2));
}

void write_fake_run(const std::filesystem::path& dir, const FakeRunOptions& o) {
  std::filesystem::create_directories(dir);
  const std::vector<Moment> flight = fly(o);
  std::ofstream(dir / "mission.info")
      << "seed 7\ncave\n{\n  file \"/caves/winding_tunnel.info\"\n}\npolicy\n{\n  name "
         "lateral\n  weight 0.5\n}\nmap\n{\n  resolution \""
      << o.map_resolution_m << " m\"\n}\nmotion\n{\n  max_speed \"2 m/s\"\n}\n";
  std::ofstream(dir / "timing.json")
      << R"({"simulated_s_per_wall_s": 6.4, "jobs": {"map": {"count": 812, "mean_ms": 7.1, "p50_ms": 6.2, "p99_ms": 19.5,
  "max_ms": 31}, "plan": {"count": 21, "mean_ms": 14, "p50_ms": 11, "p99_ms": 40, "max_ms": 41}}})";
  write_growth(dir / "map_growth.bin", wall_cells(o, flight));
  write_events(dir / "events.jsonl", flight, o);
  write_tables(dir, flight, o);
}

TemporaryDirectory::TemporaryDirectory() {
  std::string name =
      (std::filesystem::temp_directory_path() / "karst_evaluation_").string() + std::string(6, 'X');
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary directory: " + name);
  path_ = name;
}
TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}
void TemporaryDirectory::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path_ / name, std::ios::binary) << bytes;
}

}  // namespace karst::test
