#include "tests/robustness/trial_cave.h"

#include <unistd.h>

#include <fstream>
#include <numbers>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/random.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/host/isolation/process.h"

namespace karst::robustness {
namespace {

namespace fs = std::filesystem;
using core::Random;
using core::Vec3;

constexpr double kGenerationLimit_s = 600;
// Surface to surface a boulder falls at least so far from the vehicle: it stops from 2 m/s within 2 m.
constexpr double kFallsAhead_m = 3;

/// Trials that begin together may want the same cave: each makes its own, and the rename decides.
fs::path generated(const Trial& t, const fs::path& karst, const fs::path& caves) {
  const fs::path info = caves / (t.cave_name() + ".info");
  if (fs::exists(info)) return info;
  const fs::path own =
      caves / (t.cave_name() + "." + std::to_string(getpid()) + "." + std::to_string(t.number));
  fs::create_directories(own);
  const host::ProcessOutput made = host::run_process(
      {karst.string(), "cave", "generate", "--preset", t.cave.kind, "--seed", std::to_string(t.cave_seed),
       "--set", "volume=" + std::to_string(t.cave_volume_m3), "--out", (own / t.cave_name()).string()},
      kGenerationLimit_s);
  if (made.end.exit_code != 0 || made.end.signal != 0)
    throw core::InputError(info.string(), "", "could not be generated: " + made.out);
  for (const auto& file : fs::directory_iterator(own))
    if (file.path().extension() != ".info") fs::rename(file.path(), caves / file.path().filename());
  fs::rename(own / info.filename(), info);
  fs::remove_all(own);
  return info;
}

/// A place that the start sees over a few bends: from one to the next along a ray, half way to the rock it
/// meets. Away from the start, so that the vehicle's own place stays free.
std::string boulder_before(const cave::Cave& cave, Random& r) {
  const Vec3& start = cave.description.start.position;
  const double radius_m = r.uniform(0.5, 1.5), within_m = radius_m + 0.3 + kFallsAhead_m;
  Vec3 place = start, best = start;
  for (int step = 0; step < 100 && (best - start).norm() < within_m + 1; ++step) {
    const double up = 0.3 * r.normal(), left = r.normal();
    const Vec3 direction = Vec3(r.normal(), left, up).normalized();
    const double free_m = std::min(cave.scene.ray_cast(place, direction, 30), 30.0);
    place += 0.5 * free_m * direction;
    if ((place - start).norm() > (best - start).norm()) best = place;
  }
  char text[200];
  std::snprintf(text, sizeof text,
                "boulder { position \"%.3f %.3f %.3f\" radius \"%.3f m\" within \"%.3f m\" }\n", best.x(),
                best.y(), best.z(), radius_m, within_m);
  return text;
}

std::string fault_block(const Trial& t) {
  const auto space = t.what.find(' ');
  char text[160];
  std::snprintf(text, sizeof text, "fault { sensor %s kind %s after \"%.3f s\" for \"%.3f s\" }\n",
                t.what.substr(0, space).c_str(), t.what.substr(space + 1).c_str(), t.fault_at_s,
                t.fault_for_s);
  return text;
}

}  // namespace

void write_trial_cave(const Trial& t, const fs::path& karst, const fs::path& caves, const fs::path& info) {
  fs::create_directories(caves);
  const std::string file = t.cave.mesh.empty() ? generated(t, karst, caves).string() : t.cave.mesh;
  const cave::CaveDescription described = cave::describe_cave(file, t.cave.start);
  std::ofstream out(info);
  const cave::StartPose& start = described.start;
  out << "mesh \"" << fs::absolute(described.mesh_path).string() << "\"\nstart \"" << start.position.x()
      << ' ' << start.position.y() << ' ' << start.position.z() << ' '
      << start.heading_rad * 180 / std::numbers::pi << "\"\n";
  const cave::MeshFrame& frame = described.mesh_frame;
  if (!cave::is_plain(frame))
    out << core::format_text("scale %.17g\nup %s\noffset \"%.17g %.17g %.17g\"\n", frame.metres_per_unit,
                             core::name_of(frame.up), frame.offset.x(), frame.offset.y(), frame.offset.z());
  if (t.fault == Fault::sensor_gap || t.fault == Fault::imu_dropout) out << fault_block(t);
  if (t.fault == Fault::rockfall) {
    Random r = Random::stream(static_cast<std::uint64_t>(t.number), "boulder");
    out << boulder_before(cave::load_cave(file, t.cave.start), r);
  }
  if (!out.flush()) throw core::InputError(info.string(), "", "cannot be written");
}

}  // namespace karst::robustness
