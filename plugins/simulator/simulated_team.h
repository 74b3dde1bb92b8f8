// Several simulated vehicles in one cave: each a sphere in the others' sight, and a radio on each.
#pragma once
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include "plugins/simulator/radio/radio.h"
#include "plugins/simulator/simulated_vehicle.h"
#include "plugins/simulator/simulated_world.h"

namespace karst::sim {

/// Places around `cave`'s start, itself first, where vehicles can stand side by side and rise by `climb_m`
/// each: in sight of the start, at least `apart_m` from each other. Throws InputError if there are not `n`.
std::vector<cave::StartPose> start_places(const cave::Cave& cave, std::size_t n, double radius_m,
                                          double climb_m, double apart_m = 1.5);

/// Whether two spheres touched while their centres went along straight lines in the same time.
bool touched(const core::Vec3& a0, const core::Vec3& a1, const core::Vec3& b0, const core::Vec3& b1,
             double distance_m);

/// Where the antenna of a node that leaves `from` with `velocity_mps` comes to be: 0.3 m above the rock that
/// it falls onto. There it stays, though the rock be steep. Nothing if it meets none within 20 s.
std::optional<core::Vec3> fallen(const cave::RayScene& scene, const core::Vec3& from,
                                 const core::Vec3& velocity_mps);

class SimulatedTeam final : public SimulatedWorld {
 public:
  /// Throws InputError on a bad cave or start, or one without room for all.
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
  struct Node {  // that was dropped
    int radio;
    core::Vec3 position;
  };

  /// One radio of the team, the base's and the nodes' among them.
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
  std::map<std::size_t, Port> ports_;  // made when first asked for
  std::vector<Node> nodes_;
  std::ofstream truth_;  // team_truth.jsonl: contacts, and who could hear whom
  std::string truth_file_;
};

}  // namespace karst::sim
