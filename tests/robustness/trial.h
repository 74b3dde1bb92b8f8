// What a trial of the campaign of faults flies, drawn from its number alone.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace karst::robustness {

enum class Fault {
  none,
  sensor_gap,
  imu_dropout,
  weak_motor,
  rockfall,
  policy_crash,
  policy_hang,
  radio_silence,  // in a team; the others are of one vehicle alone
  sigterm,
  disk_full
};
inline constexpr std::array kFaults{
    Fault::none,         Fault::sensor_gap,  Fault::imu_dropout,   Fault::weak_motor, Fault::rockfall,
    Fault::policy_crash, Fault::policy_hang, Fault::radio_silence, Fault::sigterm,    Fault::disk_full};
const char* name_of(Fault fault);

/// A cave to choose from: of the generator (a preset), or a mesh with its start.
struct CaveChoice {
  std::string kind;   // preset, or the mesh's name
  std::string mesh;   // "": generated
  std::string start;  // of a mesh
};
/// Every preset of the generator, and the meshes of `shared_caves` that are there ("": none).
std::vector<CaveChoice> cave_choices(const std::string& shared_caves);

struct Trial {
  int number = 0;
  CaveChoice cave;
  int cave_seed = 1;
  double cave_volume_m3 = 1000;  // of a generated cave
  std::string policy, vehicle;
  int robots = 1;
  double flight_s = 60;                  // mission.max_flight_time
  double haze_1pm = 0, stirred_1pm = 0;  // simulator.air
  bool own_process = false;              // the policy's
  Fault fault = Fault::none;
  double fault_at_s = 0, fault_for_s = 0;  // of the mission's time; a rockfall waits for the vehicle
  std::string what;                        // sensor and kind ("lidar nan"), or how the policy breaks
  int motor = 0;                           // 1 to 4
  int disk_bytes = 0;                      // greatest size of a file

  /// "maze-7": caves of the same name are the same.
  std::string cave_name() const;
  /// One line for people.
  std::string fault_text() const;
};

/// The same number and choices give the same trial. Faults come in turn, so that each comes equally often.
Trial draw_trial(int number, const std::vector<CaveChoice>& caves);

}  // namespace karst::robustness
