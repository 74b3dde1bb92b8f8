#include "plugins/simulator/truth_log.h"

#include <cmath>
#include <cstdio>

#include "core_stack/common/error.h"

namespace karst::sim {

using core::Vec3;

namespace {

void open(std::ofstream& file, const std::string& path) {
  file.open(path, std::ios::binary);
  if (!file) throw core::InputError(path, "", "cannot be written");
}

}  // namespace

TruthLog::TruthLog(const std::string& run_dir) : run_dir_(run_dir) {
  if (run_dir.empty()) return;
  open(tum_, run_dir + "/ground_truth.tum");
  open(csv_, run_dir + "/truth.csv");
  open(events_, run_dir + "/truth_events.jsonl");
  csv_ << "time_s,clearance_m,speed_mps,battery,power_w,wind_east_mps,wind_north_mps,wind_up_mps\n";
}

void TruthLog::pose(core::TimeNs stamp, const core::Pose& T) {
  if (!tum_.is_open()) return;
  char line[200];
  const auto& p = T.position;
  const auto& q = T.orientation;
  std::snprintf(line, sizeof line, "%.3f %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n", core::seconds(stamp), p.x(),
                p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  tum_ << line;
}

void TruthLog::picture(core::TimeNs stamp, const core::Pose& T, const core::RgbCameraModel& model) {
  if (run_dir_.empty()) return;
  if (!pictures_.is_open()) {
    open(pictures_, run_dir_ + "/ground_truth_frames.csv");
    pictures_ << "time_s,x,y,z,qx,qy,qz,qw,tan_half_width,tan_half_height,min_range_m,max_range_m,"
                 "max_incidence_rad\n";
  }
  char line[300];
  const auto& p = T.position;
  const auto& q = T.orientation;
  const core::CameraModel& c = model.camera;
  std::snprintf(line, sizeof line, "%.3f,%.6f,%.6f,%.6f,%.8f,%.8f,%.8f,%.8f,%.8f,%.8f,%.4f,%.4f,%.8f\n",
                core::seconds(stamp), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
                std::tan(c.horizontal_fov_rad / 2), std::tan(c.vertical_fov_rad / 2),
                static_cast<double>(c.min_range_m), static_cast<double>(c.max_range_m),
                model.max_incidence_rad);
  pictures_ << line;
}

void TruthLog::row(core::TimeNs stamp, const TruthRow& r) {
  if (!csv_.is_open()) return;
  char line[200];
  std::snprintf(line, sizeof line, "%.3f,%.4f,%.4f,%.6f,%.2f,%.4f,%.4f,%.4f\n", core::seconds(stamp),
                r.clearance_m, r.speed_mps, r.battery, r.power_w, r.wind_mps.x(), r.wind_mps.y(),
                r.wind_mps.z());
  csv_ << line;
}

void TruthLog::event(core::TimeNs stamp, const std::string& what, const BodyState& s,
                     const std::string& detail) {
  if (!events_.is_open()) return;
  char line[400];
  const Vec3& p = s.T_world_body.position;
  std::snprintf(
      line, sizeof line,
      "{\"time_s\": %.3f, \"event\": \"%s\", \"x\": %.4f, \"y\": %.4f, \"z\": %.4f, \"speed_mps\": %.4f, "
      "\"detail\": \"%s\"}\n",
      core::seconds(stamp), what.c_str(), p.x(), p.y(), p.z(), s.velocity_mps.norm(), detail.c_str());
  events_ << line;
}

void TruthLog::object(core::TimeNs stamp, const char* what, std::size_t number, const cave::CaveObject& o) {
  if (run_dir_.empty()) return;
  if (!objects_.is_open()) open(objects_, run_dir_ + "/truth_objects.jsonl");
  char line[240];
  const Vec3& p = o.position;
  std::snprintf(
      line, sizeof line,
      "{\"time_s\": %.3f, \"event\": \"%s\", \"number\": %zu, \"what\": \"%s\", \"position\": [%.4f, "
      "%.4f, %.4f]}\n",
      core::seconds(stamp), what, number, core::name_of(o.kind), p.x(), p.y(), p.z());
  objects_ << line;
}

void TruthLog::flush() {
  tum_.flush();
  csv_.flush();
  events_.flush();
  pictures_.flush();
  objects_.flush();
}

void TruthLog::close() {
  if (run_dir_.empty()) return;
  flush();
  const bool whole = tum_.good() && csv_.good() && events_.good() && pictures_.good() && objects_.good();
  tum_.close();
  csv_.close();
  events_.close();
  pictures_.close();
  objects_.close();
  if (!whole)
    throw core::InputError(run_dir_, "", "ground truth could not be written completely; is the disk full?");
}

}  // namespace karst::sim
