// A cave: the rock that sensors measure and vehicles collide with, its material, and the start pose.
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/vehicle/mesh_keys.h"
#include "core_stack/vehicle/object_detection.h"
#include "plugins/simulator/cave/mesh_frame.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::cave {

/// A pose in the air. The vehicle is set down on the floor below it, and its first hover is the mission's
/// take-off height above that floor position.
struct StartPose {
  core::Vec3 position = core::Vec3::Zero();
  double heading_rad = 0;
};

/// A ball in which rock has another reflectivity: wet walls, a chalk band, a sheet of metal.
struct Patch {
  core::Vec3 position = core::Vec3::Zero();
  double radius_m = 1, reflectivity = 0.1;
};

/// Ferromagnetic ore as a magnetic dipole; the moment in A m^2, world frame.
struct OreBody {
  core::Vec3 position = core::Vec3::Zero(), moment_am2 = core::Vec3::Zero();
};

/// Rock that appears later or moves: a rockfall that closes a passage, a swinging gate. A ball that exists
/// from `after_s` on, and, if `within_m` is not 0, once the vehicle has first come so near to `position`.
/// With a speed it moves back and forth between `position` and `to`.
struct LooseRock {
  core::Vec3 position = core::Vec3::Zero(), to = core::Vec3::Zero();
  double radius_m = 1, after_s = 0, within_m = 0, speed_mps = 0;
};

/// Dust or droplets suspended in the air, of uniform density in a ball or an axis-aligned box.
struct Cloud {
  core::Vec3 position = core::Vec3::Zero();          // its centre
  core::Vec3 half_size_m = core::Vec3::Constant(1);  // of a ball: its radius, three times
  bool box = false;
  double extinction_1pm = 0.3;  // extinction coefficient: I = I0 exp(-extinction * path length)
  double lidar_ratio_sr = kDust_sr;
  double after_s = 0;  // exists from then on

  /// Extinction over backscatter. Dust of deserts 55 +- 5 sr (Mueller et al., J. Geophys. Res. 112, 2007, of
  /// Saharan dust), droplets 18.8 +- 0.8 sr at the 905 nm of a LiDAR (O'Connor, Illingworth, Hogan, J. Atmos.
  /// Oceanic Technol. 21, 2004).
  static constexpr double kDust_sr = 55, kDroplets_sr = 18.8;
};

/// A sensor fault. It affects every message measured in [after, after + lasts), and at least the first one
/// from `after` on.
struct Fault {
  enum class Sensor { lidar, imu, magnetometer, barometer, camera, pose };
  enum class Kind {
    lost,          // no message
    nan,           // every second range and every third intensity is NaN; LiDAR only, as are the next
    three_points,  // three returns are left
    stamp_back,    // stamped 250 ms early: before scans that came earlier
    stamp_ahead    // stamped 250 ms late: in the future
  };
  Sensor sensor = Sensor::lidar;
  Kind kind = Kind::lost;
  double after_s = 0, lasts_s = 0;
};
constexpr auto names_of(Fault::Sensor) {
  using enum Fault::Sensor;
  return std::to_array<core::Named<Fault::Sensor>>({{lidar, "lidar"},
                                                    {imu, "imu"},
                                                    {magnetometer, "magnetometer"},
                                                    {barometer, "barometer"},
                                                    {camera, "camera"},
                                                    {pose, "pose"}});
}
constexpr auto names_of(Fault::Kind) {
  using enum Fault::Kind;
  return std::to_array<core::Named<Fault::Kind>>({{lost, "lost"},
                                                  {nan, "nan"},
                                                  {three_points, "three_points"},
                                                  {stamp_back, "stamp_back"},
                                                  {stamp_ahead, "stamp_ahead"}});
}

/// An object of interest. Detectors see it, but it is neither hit by rays nor touched.
struct CaveObject {
  core::ObjectKind kind = core::ObjectKind::backpack;
  core::Vec3 position = core::Vec3::Zero();  // its centre
  core::Vec3 normal = core::Vec3::Zero();    // unit, of the rock it lies on; 0: seen from all sides
};

struct CaveDescription {
  std::string file;       // as named by the user
  std::string mesh_path;  // the same, or the mesh that the .info file names
  MeshFrame mesh_frame;   // of the mesh's file; all other places are in metres with z up
  StartPose start;
  double reflectivity = 0.5;  // of bare rock, 0..1
  std::vector<Patch> patches;
  std::vector<OreBody> ore_bodies;
  std::vector<LooseRock> boulders;
  std::vector<Cloud> clouds;
  std::vector<Fault> faults;
  std::vector<CaveObject> objects;
};

/// Reads a cave `.info` file, or describes a bare mesh, which requires `start` ("x y z [heading_deg]"; if not
/// empty it replaces the file's own). `mesh` is for a bare mesh: in a cave file the keys stand in the file.
/// Throws InputError. The file's keys, by example:
///
///   mesh tunnel.ply              ; relative to this file
///   unit mm                      ; of the mesh: m (default), cm, mm, ft, in
///   scale 1                      ; of the mesh, beside the unit
///   up y                         ; of the mesh: z (default) or y
///   offset "1000 0 2000"         ; in the mesh's own coordinates, subtracted first
///   start "1 2 1.5 90"           ; x y z in metres, heading in degrees counter-clockwise from east
///   reflectivity 0.5
///   patch { position "4 2 1" radius "3 m" reflectivity 0.1 }     ; any number of blocks, here and below
///   ore { position "9 0 -2" moment "0 0 4000" }
///   boulder { position "20 3 1" radius "2.5 m" after "30 s" within "7 m" to "20 9 1" speed "0.5 m/s" }
///   cloud { position "12 2 1" radius "2 m" extinction "0.4 1/m" of droplets after "30 s" }
///   cloud { position "12 2 1" size "8 4 3" extinction "0.1 1/m" of dust }
///   fault { sensor lidar kind lost after "40 s" for "1 s" }
///   object { kind backpack position "20 3 0.2" }
CaveDescription describe_cave(const std::string& path, const std::string& start,
                              const core::MeshKeys& mesh = {});

/// The mesh of a cave, for what needs no start. Throws InputError.
MeshFile mesh_of(const std::string& path, const core::MeshKeys& mesh = {});
inline MeshFile mesh_of(const CaveDescription& cave) { return {cave.mesh_path, cave.mesh_frame}; }

/// Whether the cave's file gives a start; a bare mesh has none. Throws InputError.
bool has_start(const std::string& path);

struct Cave {
  CaveDescription description;
  RayScene scene;
};

/// describe_cave, then loads its mesh and places the objects on it (lay_objects).
Cave load_cave(const std::string& path, const std::string& start, const core::MeshKeys& mesh = {});

/// Reflectivity of the rock at a position: that of the last patch that contains it.
double reflectivity_at(const CaveDescription& cave, const core::Vec3& place);

}  // namespace karst::cave
