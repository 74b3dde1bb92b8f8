// Several simulated vehicles in one cave: the others' sensors see each as a sphere, and each carries a radio.
#pragma once
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include "plugins/simulator/radio/radio.h"
#include "plugins/simulator/simulated_vehicle.h"
#include "plugins/simulator/simulated_world.h"

namespace karst::sim {

/// Start poses around `cave`'s start (which comes first) where vehicles can stand side by side and climb by
/// `climb_m`: in sight of the start, at least `apart_m` from each other. Throws InputError if fewer than `n`.
std::vector<cave::StartPose> start_places(const cave::Cave& cave, std::size_t n, double radius_m,
                                          double climb_m, double apart_m = 1.5);

/// Whether two spheres touched while their centres moved at constant velocity, a0 to a1 and b0 to b1.
bool touched(const core::Vec3& a0, const core::Vec3& a1, const core::Vec3& b0, const core::Vec3& b1,
             double distance_m);

/// Position of the antenna of a node dropped at `from` with `velocity_mps` (world): 0.3 m above the rock that
/// it falls onto, where it stays even on steep rock. nullopt if it meets no rock within 20 s.
std::optional<core::Vec3> fallen(const cave::RayScene& scene, const core::Vec3& from,
                                 const core::Vec3& velocity_mps);

class SimulatedTeam final : public SimulatedWorld {
 public:
  /// Throws InputError on a bad cave or start, or if there is no room for all vehicles.
  SimulatedTeam(const SimulatorOptions& options, const RadioOptions& radio, const WorldSetup& setup);

  core::Vehicle& robot(std::size_t i) override { return *robots_.at(i); }
  core::TeamPort& port(std::size_t robot) override { return port_of(robot + 1); }
  core::RadioPort& radio(std::size_t number) override { return port_of(number); }
  std::string start_of(std::size_t i) const override;
  core::Vec3 base() const override { return cave_.description.start.position; }
  void meet(core::TimeNs now) override;
  void silence(std::size_t radio) override { radio_.switch_off(static_cast<int>(radio)); }
  void wreck(std::size_t robot, const std::string& reason) override;
  RadioTraffic traffic(std::size_t radio) const override;
  void finish() override;

 private:
  struct Node {  // a dropped radio node
    int radio;
    core::Vec3 position;
  };

  /// One radio of the team: a robot's, the base's or a node's.
  class Port final : public core::TeamPort {
   public:
    Port(SimulatedTeam& team, std::size_t radio) : team_(team), radio_(radio) {}
    void send(std::span<const std::uint8_t> frame, core::TimeNs now) override;
    std::vector<std::vector<std::uint8_t>> receive(core::TimeNs until) override;
    void drop_node(std::size_t radio) override { team_.drop_node(radio_ - 1, radio); }

   private:
    SimulatedTeam& team_;
    std::size_t radio_;
  };

  Port& port_of(std::size_t radio);
  void drop_node(std::size_t robot, std::size_t radio);
  void count_contacts(core::TimeNs now);
  void log(core::TimeNs now);

  double radius_m_;
  cave::Cave cave_;
  std::vector<cave::StartPose> starts_;
  std::vector<std::unique_ptr<SimulatedVehicle>> robots_;
  std::vector<core::Vec3> last_;  // positions at the last meeting
  Radio radio_;
  std::map<std::size_t, Port> ports_;  // made on first use
  std::vector<Node> nodes_;
  std::ofstream truth_;  // team_truth.jsonl: contacts, and pairs in radio range
  std::string truth_file_;
};

}  // namespace karst::sim
