#include "core_stack/mission/onboard/explorer.h"

namespace karst::core {

Explorer::Explorer(const CoreOptions& options, const VehicleDescription& vehicle, PolicyPort& policy)
    : limits_(clearance_limits(options.planning, vehicle)),
      world_(options, vehicle),
      home_estimator_(options, vehicle, world_, team_),
      cycle_(options, vehicle, policy, world_, home_estimator_),
      horizon_(vehicle) {}

std::vector<CellChange> Explorer::integrate(const std::vector<Ray>& rays) {
  std::vector<CellChange> changes = world_.integrate(rays);
  team_.note(changes);
  return changes;
}

std::vector<CellChange> Explorer::declare_launch_site(const Vec3& hover_point) {
  std::vector<CellChange> changes = world_.declare_launch_site(hover_point);
  team_.note(changes);
  return changes;
}

void Explorer::note_picture(const Pose& T_world_camera) { world_.note_picture(T_world_camera); }

CycleResult Explorer::decide(const CycleInput& input) { return cycle_.decide(input, team_.claims()); }

std::optional<HorizonPlan> Explorer::plan_horizon(const HorizonQuery& query,
                                                  std::optional<double> exploring_s) {
  return horizon_.plan(world_, query, exploring_s);
}

void Explorer::tell(const std::vector<PolicyEvent>& events, TimeNs now) { cycle_.tell(events, now); }

bool Explorer::cluster_alive(std::uint32_t id) const { return cycle_.cluster_alive(id); }

Path Explorer::plan_to(const Vec3& from, const Vec3& to) { return world_.plan_to(from, to); }

HomeEstimate Explorer::estimate_home(const Vec3& from, double flown_length_m) {
  return home_estimator_.estimate(from, flown_length_m);
}

std::vector<Vec3> Explorer::path_back(const std::vector<Vec3>& flown) const {
  std::vector<Vec3> back = flown_back(world_.map(), limits_, flown);
  back.push_back(world_.home());
  return back;
}

int Explorer::touching_segment(const std::vector<Vec3>& points) const {
  return core::touching_segment(world_.map(), limits_, points);
}

int Explorer::blocked_segment(const std::vector<Vec3>& points, const std::vector<Vec3>& narrow_places) const {
  return core::blocked_segment(world_.map(), limits_, points, narrow_places);
}

std::optional<double> Explorer::hull_clearance_m(const Vec3& p) const {
  return core::hull_clearance_m(world_.map(), limits_, p);
}

Vec3 Explorer::hover_below(const Vec3& highest) const {
  return core::hover_below(world_.map(), limits_, highest);
}

void Explorer::join(RelayHoming* homing, double claim_radius_m) { team_.join(homing, claim_radius_m); }

TreeFacts Explorer::share(const Vec3& here, const TeamNews& news) {
  return team_.share(world_.map(), world_.usual().roadmap(), here, news);
}

std::optional<Vec3> Explorer::relay_drop_site(const Release& here, const Release& ahead) const {
  return team_.homing()->relay_drop_site(world_.map(), here, ahead);
}

std::optional<LandingSpot> Explorer::landing_spot(const Vec3& from, double flown_length_m) {
  return home_estimator_.landing_spot(from, flown_length_m);
}

TreeFacts Explorer::land(const Vec3& hover, TimeNs team_time) {
  return team_.homing()->land(world_.map(), world_.usual().roadmap(), hover, team_time);
}

std::optional<WaitingPlace> Explorer::find_waiting_place(RoomQuery query) {
  query.vehicle_radius_m = limits_.hull_radius_m;
  return waiting_place(world_.map(), world_.usual().roadmap(), query);
}

}  // namespace karst::core
