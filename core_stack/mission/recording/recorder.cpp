#include "core_stack/mission/recording/recorder.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "core_stack/mission/recording/map_cells.h"

namespace karst::core {
namespace {

constexpr const char *kFramesName = "frames.csv", *kUnsurveyedName = "unsurveyed.csv";

template <class... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
  std::array<char, 512> line;
  const int n = std::snprintf(line.data(), line.size(), format, numbers...);
  return {line.data(), static_cast<std::size_t>(n)};
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& run_dir, Durability durability) : directory_(run_dir) {
  std::error_code error;
  std::filesystem::create_directories(run_dir, error);
  if (error) throw InputError(run_dir.string(), "", "the run directory cannot be made: " + error.message());
  if (std::filesystem::exists(run_dir / "events.jsonl"))
    throw InputError(run_dir.string(), "", "holds another run already; choose another --out or remove it");
  if (durability == Durability::survives_a_power_cut) disk_ = std::make_unique<DiskWriter>(run_dir);
  events_.open(run_dir / "events.jsonl", disk_.get());
  trajectory_.open(run_dir / "trajectory.tum", disk_.get());
  telemetry_.open(run_dir / "telemetry.csv", disk_.get());
  localization_.open(run_dir / "localization.csv", disk_.get());
  growth_.open(run_dir / "map_growth.bin", disk_.get());
  decisions_.open(run_dir / "decisions.csv", disk_.get());
  if (disk_) {  // in flight no file is made: that may wait for the disk
    cells_.open(run_dir / kMapCellsName, disk_.get());
    frames_.open(run_dir / kFramesName, disk_.get());
    unsurveyed_.open(run_dir / kUnsurveyedName, disk_.get());
  }
  telemetry_ << kTelemetryColumns << '\n';
  localization_ << kLocalizationColumns << '\n';
  decisions_ << "t_s,decide_ms,plan_ms\n";
}

void Recorder::put(RecordFile& file, RecordPart part, std::string_view bytes) {
  file << bytes;
  if (listener_) listener_->on_record(part, bytes);
}

void Recorder::write(TimeNs t, const event::Event& event) {
  put(events_, RecordPart::events, event::line_of(t, event) + '\n');
}

void Recorder::write(TimeNs t, const char* kind, const std::string& fields) {
  put(events_, RecordPart::events, event::line_of(t, kind, fields) + '\n');
}

void Recorder::pose(const State& s) {
  const Quat& q = s.orientation;
  put(trajectory_, RecordPart::trajectory,
      formatted("%.4f %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n", seconds(s.stamp), s.position.x(), s.position.y(),
                s.position.z(), q.x(), q.y(), q.z(), q.w()));
}

void Recorder::telemetry(const Telemetry& r) {
  const Vec3 &p = r.state.position, &v = r.state.velocity_mps;
  put(telemetry_, RecordPart::telemetry,
      formatted("%.2f,%s,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.5f,%.4f,%.4f,%.4f,%.5f,%.1f,%.3f,%.2f\n",
                seconds(r.stamp), name_of(r.phase), p.x(), p.y(), p.z(), v.x(), v.y(), v.z(),
                heading_of(r.state.orientation), r.reference.x(), r.reference.y(), r.reference.z(),
                r.battery_fraction, r.battery_seconds_left, r.explored_m3, r.home_distance_m));
}

void Recorder::unsurveyed(TimeNs t, double volume_m3) {
  const std::string volume = formatted("%.3f", volume_m3);
  if (volume == last_unsurveyed_) return;
  if (!unsurveyed_.is_open()) unsurveyed_.open(directory_ / kUnsurveyedName, nullptr);
  if (unsurveyed_.empty()) unsurveyed_ << "t_s,unsurveyed_m3\n";
  unsurveyed_ << formatted("%.2f,", seconds(t)) << volume << '\n';
  last_unsurveyed_ = volume;
}

void Recorder::located(const Located& r) {
  const LoamPose& p = r.pose;
  put(localization_, RecordPart::localization,
      formatted("%.3f,%.3f,%d,%d,%d,%d,%.4f,%.4f,%.5f,%s,", seconds(p.stamp), seconds(r.used_at), r.accepted,
                p.free_directions, p.edges, p.planes, p.rms_residual_m, r.position_sigma_m,
                r.heading_sigma_rad, name_of(r.believed)) +
          p.problem + '\n');
}

void Recorder::map_changes(TimeNs t, std::span<const CellChange> changes) {
  const auto ms = static_cast<std::int32_t>(t / kMillisecond);
  if (cells_.is_open())
    for (const CellChange& c : changes) cells_ << bytes_of(MapCellRecord{c.key, c.after, ms});
  for (const CellChange& c : changes) {
    if (c.before != Cell::occupied && c.after != Cell::occupied) continue;
    const std::array<std::int32_t, 4> record{c.key.x, c.key.y, c.key.z, c.after == Cell::occupied ? ms : -ms};
    put(growth_, RecordPart::map_growth,
        std::string_view(reinterpret_cast<const char*>(record.data()), sizeof record));
  }
}

void Recorder::frame(const RgbFrame& frame, const Pose& T, const std::string& file) {
  if (!frames_.is_open()) frames_.open(directory_ / kFramesName, nullptr);
  if (frames_.empty()) frames_ << "stamp_s,file,x,y,z,qx,qy,qz,qw,width,height,fx,fy,cx,cy\n";
  const CameraModel& c = frame.model->camera;
  const Quat& q = T.orientation;
  frames_ << formatted("%.3f,", seconds(frame.stamp)) << file
          << formatted(",%.4f,%.4f,%.4f,%.7f,%.7f,%.7f,%.7f,%d,%d,%.4f,%.4f,%.2f,%.2f\n", T.position.x(),
                       T.position.y(), T.position.z(), q.x(), q.y(), q.z(), q.w(), c.width, c.height,
                       c.width / 2.0 / std::tan(c.horizontal_fov_rad / 2),
                       c.height / 2.0 / std::tan(c.vertical_fov_rad / 2), c.width / 2.0, c.height / 2.0);
}

void Recorder::objects(const nlohmann::ordered_json& objects) {
  std::ofstream out(directory_ / "objects.json", std::ios::binary | std::ios::trunc);
  if (!out) throw InputError((directory_ / "objects.json").string(), "", "cannot be written");
  out << json_text(objects, 2) << '\n';
}

void Recorder::decision_cost(TimeNs t, double decide_ms, double plan_ms) {
  decisions_ << formatted("%.2f,%.3f,%.3f\n", seconds(t), decide_ms, plan_ms);
}

void Recorder::final_map(const VoxelMap& map) {
  write_octomap(map, (directory_ / "map").string());
  write_ply(map, (directory_ / "map.ply").string());
}

std::array<RecordFile*, 9> Recorder::files() {
  return {&events_, &trajectory_, &telemetry_, &localization_, &growth_,
          &cells_,  &decisions_,  &frames_,    &unsurveyed_};
}

bool Recorder::flush() {
  bool good = true;
  for (RecordFile* f : files()) good = f->flush() && good;
  return good;
}

bool Recorder::close() {
  bool good = true;
  for (RecordFile* f : files()) good = f->close() && good;
  if (listener_) listener_->on_close();
  if (!disk_) return good;
  good = disk_->finish() && good;
  std::error_code ignored;
  if (frames_.empty()) std::filesystem::remove(directory_ / kFramesName, ignored);
  if (unsurveyed_.empty()) std::filesystem::remove(directory_ / kUnsurveyedName, ignored);
  return good;
}

}  // namespace karst::core
