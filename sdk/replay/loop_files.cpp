#include "sdk/replay/loop_files.h"

#include <cstdio>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/so3.h"
#include "plugins/replay/scan_files/decimal_time.h"

namespace karst::replay {

void write_loops(const std::filesystem::path& file, const core::LoopClosing& loops, core::TimeNs origin) {
  std::ofstream out(file, std::ios::trunc);
  out << "older_s,newer_s,state,older_x,older_y,older_z,newer_x,newer_y,newer_z,x,y,z,qx,qy,qz,qw,overlap,"
         "residual_m,hold,correction_m,correction_deg\n";
  for (std::size_t i = 0; i < loops.closures().size(); ++i) {
    const core::FoundClosure& f = loops.closures()[i];
    const core::Submap &older = loops.submaps()[f.closure.older], &newer = loops.submaps()[f.closure.newer];
    const core::Pose T_older_newer =
        older.T_submap_body.inverse() * f.closure.T_older_newer * newer.T_submap_body;
    const core::Vec3 a = loops.poses()[f.closure.older].position, b = loops.poses()[f.closure.newer].position,
                     p = T_older_newer.position;
    const core::Quat q = T_older_newer.orientation;
    std::array<char, 512> line;
    std::snprintf(
        line.data(), line.size(),
        "%s,%s,%s,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,%.7f,%.7f,%.7f,%.7f,%.3f,%.4f,%.3f,%.3f,"
        "%.2f\n",
        decimal_seconds(origin + older.first).c_str(), decimal_seconds(origin + newer.first).c_str(),
        name_of(f.state), a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
        q.w(), f.closure.overlap, f.closure.residual_m, f.closure.hold, f.correction.position.norm(),
        core::log_so3(f.correction.orientation).norm() * 180 / std::numbers::pi);
    out << line.data();
  }
  if (!out.flush()) throw core::InputError(file.string(), "", "cannot be written: is the disk full?");
}

}  // namespace karst::replay
