#include "sdk/host/services/session.h"

#include <memory>
#include <utility>

namespace karst::host {
namespace {

constexpr std::size_t kMaxLogLines = 200;  // between two decisions

}  // namespace

Session::Session(std::uint64_t seed, const std::string& policy_id, std::uint64_t numbers_drawn)
    : random_(core::Random::stream(seed, "policy " + policy_id)), numbers_drawn_(numbers_drawn) {
  for (std::uint64_t i = 0; i < numbers_drawn; ++i) random_.uniform();
  install_services(*this, host_);
}

void Session::begin_deciding(const core::DecisionRequest& request, const PathLengths& lengths,
                             const PathSearch& paths) {
  const std::unique_lock lock(gate_);
  now_ = request.stamp;
  live_.map = request.map;
  live_.revision = request.map == nullptr ? 0 : request.map->revision();
  live_.start = request.T_world_start.position;
  live_.passages = std::make_shared<PassageQuestion>();
  lengths_ = lengths;
  if (!lengths_ && request.map != nullptr && request.roadmap != nullptr)
    lengths_ = [&map = *request.map, &roadmap = *request.roadmap](
                   const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m) {
      return path_lengths(map, roadmap, from, goals, tolerance_m);
    };
  paths_ = paths;
  if (!paths_ && request.map != nullptr && request.roadmap != nullptr)
    paths_ = [&map = *request.map, &roadmap = *request.roadmap](
                 const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m) {
      return find_paths(map, roadmap, from, goals, tolerance_m);
    };
  motion_.max_speed_mps = request.max_speed_mps;
  motion_.max_acceleration_mps2 = request.max_acceleration_mps2;
  imaged_ = request.imaged;
  survey_ = request.survey;
  rgb_ = request.vehicle == nullptr ? nullptr : request.vehicle->rgb.get();
}

void Session::end_deciding() {
  const std::unique_lock lock(gate_);
  live_.map = nullptr;
  live_.passages = std::make_shared<PassageQuestion>();
  lengths_ = {};
  paths_ = {};
  imaged_ = nullptr;
  survey_ = nullptr;
  rgb_ = nullptr;
  unimaged_.reset();
}

void Session::abandon() {
  abandoned_ = true;  // long-running services check it
  end_deciding();
}

const Snapshot* Session::find(const karst_map_t* map) {
  if (map == live_map()) return live_.map == nullptr ? nullptr : &live_;
  const std::lock_guard lock(kept_mutex_);
  const auto it = kept_.find(map);
  return it == kept_.end() ? nullptr : it->second.get();
}

std::vector<core::Drawing> Session::take_drawings() {
  const std::lock_guard lock(output_mutex_);
  drawn_points_ = 0;
  return std::exchange(drawings_, {});
}

std::vector<std::string> Session::take_log() {
  const std::lock_guard lock(output_mutex_);
  return std::exchange(log_, {});
}

void Session::note(std::string line) {
  const std::lock_guard lock(output_mutex_);
  if (log_.size() < kMaxLogLines) log_.push_back(std::move(line));
  if (log_.size() == kMaxLogLines) log_.back() = "(more lines were dropped)";
}

}  // namespace karst::host
