// The run directory, written as the flight goes: complete up to the last second whatever happens.
// docs/run_directory.md describes every file.
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "core_stack/localization/loam.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mission/recording/disk_writer.h"
#include "core_stack/mission/recording/record_file.h"
#include "core_stack/mission/recording/record_listener.h"
#include "core_stack/mission/recording/run_event.h"
#include "core_stack/vehicle/rgb_camera_model.h"

namespace karst::core {

/// One line of telemetry.csv.
struct Telemetry {
  TimeNs stamp = 0;
  Phase phase = Phase::standby;
  State state;
  Vec3 reference = Vec3::Zero();
  double battery_fraction = 0, battery_seconds_left = 0;
  double explored_m3 = 0;
  double home_distance_m = 0;  // by path; NaN while unknown
};

/// One line of localization.csv: a scan, and what the estimate made of its pose.
struct Located {
  TimeNs used_at = 0;
  LoamPose pose;
  bool accepted = false;
  double position_sigma_m = 0, heading_sigma_rad = 0;  // of the estimate, after it
  Hypothesis believed = Hypothesis::lidar;
};

/// Where the record is once flush() has returned: with the file system, which a killed process does not
/// affect; or on its way to the disk: it gets there within a second, if the disk keeps up.
/// The second also records every known cell of the map (map_cells.bin), and no call waits for the disk.
enum class Durability { survives_a_crash, survives_a_power_cut };

class Recorder {
 public:
  /// The first lines of telemetry.csv and localization.csv.
  static constexpr std::string_view kTelemetryColumns =
      "t_s,phase,x,y,z,vx,vy,vz,heading_rad,ref_x,ref_y,ref_z,battery_fraction,seconds_left,explored_m3,"
      "home_distance_m";
  static constexpr std::string_view kLocalizationColumns =
      "stamp_s,used_s,accepted,free_directions,edges,planes,residual_m,position_sigma_m,heading_sigma_rad,"
      "believed,problem";

  /// Creates the directory; throws InputError if it cannot be written or holds another run's files.
  explicit Recorder(const std::filesystem::path& run_dir,
                    Durability durability = Durability::survives_a_crash);

  /// From now on `listener`, which outlives the recorder, gets what is recorded, without the columns' names.
  void set_listener(RecordListener* listener) { listener_ = listener; }

  /// A line of events.jsonl.
  void write(TimeNs t, const event::Event& event);
  /// The same of fields that were made into text elsewhere, where there is time for it (event::fields_text).
  void write(TimeNs t, const char* kind, const std::string& fields);
  void pose(const State& state);
  void telemetry(const Telemetry& row);
  /// A line of unsurveyed.csv, made with the first, if the volume differs from the last line's.
  void unsurveyed(TimeNs t, double volume_m3);
  void located(const Located& row);
  void map_changes(TimeNs t, std::span<const CellChange> changes);
  /// A line of frames.csv, made with the first; `file` is relative to the directory, "" if no picture is
  /// kept.
  void frame(const RgbFrame& frame, const Pose& T_world_camera, const std::string& file);
  /// objects.json: objects of interest as known at the end.
  void objects(const nlohmann::ordered_json& objects);
  /// Wall-clock costs of a decision, apart from what must replay byte for byte.
  void decision_cost(TimeNs t, double decide_ms, double plan_ms);
  /// Final map in all its formats.
  void final_map(const VoxelMap& map);
  /// Hands on what is buffered; false once a write has failed (disk full, removed).
  bool flush();
  /// Waits until all of it is where the durability says.
  bool close();

  /// Writes further files of the directory; null if nothing must survive a power cut.
  DiskWriter* disk() const { return disk_.get(); }
  const std::filesystem::path& directory() const { return directory_; }

 private:
  std::array<RecordFile*, 9> files();
  void put(RecordFile& file, RecordPart part, std::string_view bytes);

  std::filesystem::path directory_;
  std::unique_ptr<DiskWriter> disk_;  // to survive a power cut
  RecordFile events_, trajectory_, telemetry_, localization_, growth_, cells_, decisions_, frames_,
      unsurveyed_;
  std::string last_unsurveyed_;  // as written
  RecordListener* listener_ = nullptr;
};

}  // namespace karst::core
