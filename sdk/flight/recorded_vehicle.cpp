#include "sdk/flight/recorded_vehicle.h"

#include <fstream>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "sdk/flight/recorded_scan.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;
using core::format_text;
using core::InputError;
using core::seconds;
using core::TimeNs;

constexpr TimeNs kScanBudget = core::kSecond / 2;
constexpr int kMaxWaiting = 16;  // scans, in real time: later ones are lost

void write_file(const fs::path& file, std::string& bytes, core::DiskWriter* disk) {
  if (disk) {  // that it failed shows when the record is closed
    disk->write_whole(file, bytes);
    return;
  }
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw InputError(file.string(), "", "cannot be written; is the disk full?");
}

std::string row(TimeNs stamp, const core::Vec3& v) {
  return format_text("%.9f,%.9g,%.9g,%.9g", seconds(stamp), v.x(), v.y(), v.z());
}

}  // namespace

RecordedVehicle::RecordedVehicle(core::Vehicle& vehicle, core::Recorder& recorder)
    : vehicle_(vehicle), disk_(recorder.disk()), folder_(recorder.directory() / "scans") {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw InputError(folder_.string(), "", "cannot be made: " + error.message());
  imu_.open(folder_ / "imu.csv", disk_);
  compass_.open(folder_ / "compass.csv", disk_);
  barometer_.open(folder_ / "barometer.csv", disk_);
  imu_ << "t,ax,ay,az,wx,wy,wz\n";
  compass_ << "t,x_ut,y_ut,z_ut\n";
  barometer_ << "t,height_m\n";
}

void RecordedVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sink_ = &sink;
  if (const auto lidar = vehicle_.description().lidar) {
    std::string info = recording_info_of(*lidar);
    write_file(folder_ / "recording.info", info, disk_);
  }
  vehicle_.start(executive, *this);
}

void RecordedVehicle::on_lidar(std::shared_ptr<const core::LidarScan> scan) {
  if (scan && scan->model) record(scan);
  sink_->on_lidar(std::move(scan));
}

/// Replays want stamps that rise: a scan that a clock stamped anew is left out.
void RecordedVehicle::record(const std::shared_ptr<const core::LidarScan>& scan) {
  const TimeNs begin = sweep_begin(*scan);
  if (begin <= last_begin_) return;
  if (executive_->under_way("scan file") >= kMaxWaiting) {
    ++scans_lost_;
    return;
  }
  last_begin_ = begin;
  const fs::path file = folder_ / format_text("%015lld.pcd", static_cast<long long>(begin));
  executive_->job(
      "scan file", core::Lane::pictures, kScanBudget,
      [scan, file, problem = problem_, disk = disk_] {
        try {
          std::string bytes = pcd_of(*scan);
          if (!bytes.empty()) write_file(file, bytes, disk);
        } catch (const std::exception& e) {
          problem->note(e.what());
        }
      },
      [] {});
}

void RecordedVehicle::on_imu(const core::ImuSample& s) {
  if (s.stamp > last_imu_) {
    const core::Vec3& w = s.body_rate_radps;
    imu_ << row(s.stamp, s.specific_force_mps2) << format_text(",%.9g,%.9g,%.9g\n", w.x(), w.y(), w.z());
    if (s.stamp / core::kSecond != last_imu_ / core::kSecond)
      for (core::RecordFile* file : {&imu_, &compass_, &barometer_}) check(file->flush());
    last_imu_ = s.stamp;
  }
  sink_->on_imu(s);
}

void RecordedVehicle::on_magnetometer(const core::MagnetometerSample& s) {
  compass_ << row(s.stamp, s.field_ut) << '\n';
  sink_->on_magnetometer(s);
}

void RecordedVehicle::on_barometer(const core::BarometerSample& s) {
  barometer_ << format_text("%.9f,%.9g\n", seconds(s.stamp), s.height_m);
  sink_->on_barometer(s);
}

void RecordedVehicle::check(bool written) {
  if (!written) problem_->note(folder_.string() + ": cannot be written; is the disk full?");
}

void RecordedVehicle::finish() {
  vehicle_.finish();
  for (core::RecordFile* file : {&imu_, &compass_, &barometer_}) check(file->close());
  if (scans_lost_ > 0)
    problem_->note(folder_.string() + ": " + std::to_string(scans_lost_) +
                   " scans came faster than they could be written, and are lost");
  if (const std::string problem = problem_->text(); !problem.empty()) throw std::runtime_error(problem);
}

}  // namespace karst::flight
