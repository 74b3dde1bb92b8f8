#include "sdk/host/serialization/flat_request.h"

#include <array>
#include <utility>

#include "core_stack/mapping/occupancy/voxel_classes.h"
#include "core_stack/planning/roadmap/roadmap.h"

namespace karst::host {
namespace {

constexpr std::uint64_t kMagic = 0x747365757165726bull;  // "krequest"
constexpr std::uint32_t kVersion = 5;
constexpr std::size_t kHeader = 8 + 4 + 4 + 8 + 8;  // magic, version, reserved, length, sum of the body
constexpr std::uint64_t kMaxClusters = 1'000'000, kMaxCells = 100'000'000, kMaxSensors = 64,
                        kMaxChannels = 4096, kLongestName = 1000, kMaxTeammates = 1000,
                        kMaxStations = 100'000'000;
constexpr std::size_t kKeyBytes = 12, kClusterBytes = 160, kTeammateBytes = 69, kStationBytes = 24,
                      kLegBytes = 72, kLeadBytes = 5;
constexpr std::size_t kBlockBytes = kKeyBytes + sizeof(core::ClassBlock::classes);

/// Detects damage, not tampering. Four lanes keep the multiplier busy: a snapshot of megabytes costs little.
std::uint64_t checksum(std::span<const std::byte> bytes) {
  constexpr std::uint64_t prime = 0x9e3779b97f4a7c15ull;
  std::array<std::uint64_t, 4> lane{1, 2, 3, 4};
  std::size_t i = 0;
  const auto word = [&](std::size_t at, std::size_t size) {
    std::uint64_t w = 0;
    std::memcpy(&w, bytes.data() + at, size);
    return w;
  };
  const auto mix = [](std::uint64_t& l, std::uint64_t w) {
    l = (l ^ w) * prime;
    l ^= l >> 29;
  };
  for (; i + 32 <= bytes.size(); i += 32)
    for (std::size_t j = 0; j < 4; ++j) mix(lane[j], word(i + 8 * j, 8));
  for (; i < bytes.size(); i += 8) mix(lane[0], word(i, std::min<std::size_t>(8, bytes.size() - i)));
  std::uint64_t sum = bytes.size();
  for (const std::uint64_t l : lane) mix(sum, l);
  return sum;
}

void put(FlatWriter& out, const core::CellKey& k) {
  out.put(k.x);
  out.put(k.y);
  out.put(k.z);
}
core::CellKey key(FlatReader& in) {
  const auto x = in.number<std::int32_t>(), y = in.number<std::int32_t>(), z = in.number<std::int32_t>();
  return {x, y, z};
}

void put(FlatWriter& out, const core::LidarModel& l) {
  out.put(l.name);
  out.put(l.columns);
  out.put<std::uint64_t>(l.elevation_rad.size());
  for (const float e : l.elevation_rad) out.put(e);
  out.put(l.min_range_m);
  out.put(l.max_range_m);
  out.put(l.period);
  out.put(l.T_body_lidar);
}

core::LidarModel lidar(FlatReader& in) {
  core::LidarModel l;
  l.name = in.text(kLongestName);
  l.columns = in.number<int>();
  l.elevation_rad.resize(in.count(sizeof(float), kMaxChannels, "channels"));
  for (float& e : l.elevation_rad) e = in.number<float>();
  l.min_range_m = in.number<float>();
  l.max_range_m = in.number<float>();
  l.period = in.number<core::TimeNs>();
  l.T_body_lidar = in.pose();
  return l;
}

void put(FlatWriter& out, const core::CameraModel& c) {
  out.put(c.name);
  out.put(c.width);
  out.put(c.height);
  out.put(c.horizontal_fov_rad);
  out.put(c.vertical_fov_rad);
  out.put(c.min_range_m);
  out.put(c.max_range_m);
  out.put(c.period);
  out.put(c.T_body_camera);
}

core::CameraModel camera(FlatReader& in) {
  core::CameraModel c;
  c.name = in.text(kLongestName);
  c.width = in.number<int>();
  c.height = in.number<int>();
  c.horizontal_fov_rad = in.number<double>();
  c.vertical_fov_rad = in.number<double>();
  c.min_range_m = in.number<float>();
  c.max_range_m = in.number<float>();
  c.period = in.number<core::TimeNs>();
  c.T_body_camera = in.pose();
  return c;
}

void put_vehicle(FlatWriter& out, const core::VehicleDescription* v) {
  out.put(v != nullptr);
  if (v == nullptr) return;
  out.put(v->lidar != nullptr);
  if (v->lidar) put(out, *v->lidar);
  out.put<std::uint64_t>(v->cameras.size());
  for (const auto& c : v->cameras) put(out, *c);
  out.put(v->rgb != nullptr);
  if (v->rgb) {
    put(out, v->rgb->camera);
    out.put(v->rgb->max_incidence_rad);
  }
}

void put_imaged(FlatWriter& out, const core::ImagedSurface* imaged) {
  out.put(imaged != nullptr);
  if (imaged == nullptr) return;
  const std::vector<core::CellKey> cells = imaged->cells();
  out.put<std::uint64_t>(cells.size());
  out.reserve(cells.size() * kKeyBytes);
  for (const core::CellKey& k : cells) put(out, k);
}

void put_frontiers(FlatWriter& out, const std::vector<core::FrontierOffer>& offers) {
  out.put<std::uint64_t>(offers.size());
  for (const core::FrontierOffer& o : offers) {
    const core::FrontierCluster& c = *o.cluster;
    out.put(c.id);
    out.put(c.centroid);
    out.put(c.low);
    out.put(c.high);
    out.put(c.normal);
    out.put(c.unknown_cells);
    out.put(c.free_cells);
    out.put(o.viewpoint);
    out.put(o.viewpoint_heading_rad);
    out.put(o.path_length_m);
    out.put<std::uint64_t>(c.cells.size());
    for (const core::CellKey& k : c.cells) put(out, k);
  }
}

void put_teammates(FlatWriter& out, const std::vector<core::OtherVehicle>& teammates) {
  out.put<std::uint64_t>(teammates.size());
  for (const core::OtherVehicle& v : teammates) {
    out.put(v.id);
    out.put(v.heard);
    out.put(v.position);
    out.put(v.velocity_mps);
    out.put(v.goal.has_value());
    if (v.goal) out.put(*v.goal);
    out.put(v.seconds_before_homing);
  }
}

void put_map(FlatWriter& out, const core::DecisionRequest& r, std::uint64_t since) {
  out.put(r.map != nullptr);
  if (r.map == nullptr) return;
  const std::vector<core::ClassBlock> blocks = core::blocks_changed_after(*r.map, since);
  out.put(r.map->resolution_m());
  out.put(r.map->revision());
  out.put(since);
  out.put<std::uint64_t>(blocks.size());
  out.reserve(blocks.size() * kBlockBytes);
  for (const core::ClassBlock& b : blocks) {
    put(out, b.low);
    out.put_raw(b.classes.data(), sizeof b.classes);
  }
  out.put(r.roadmap != nullptr);
  if (r.roadmap == nullptr) return;
  const core::PlanningOptions& planned = r.roadmap->options();
  out.put(planned.clearance_m);
  out.put(planned.search_slack_cells);
}

void put(FlatWriter& out, const core::PassageSize& s) {
  for (const double d : {s.left_m, s.right_m, s.up_m, s.down_m}) out.put(d);
}

core::PassageSize passage_size(FlatReader& in) {
  const auto left = in.number<double>(), right = in.number<double>(), up = in.number<double>(),
             down = in.number<double>();
  return {left, right, up, down};
}

void put_survey(FlatWriter& out, const core::SurveyedPassages* survey, std::uint64_t map_since) {
  out.put(survey != nullptr);
  if (survey == nullptr) return;
  out.put(map_since == 0);
  if (map_since != 0) return;
  const core::SurveyPrior& prior = survey->prior();
  out.put<std::uint64_t>(prior.stations.size());
  for (const core::Vec3& p : prior.stations) out.put(p);
  out.put<std::uint64_t>(prior.legs.size());
  for (const core::SurveyedLeg& l : prior.legs) {
    out.put(l.from);
    out.put(l.to);
    put(out, l.from_size);
    put(out, l.to_size);
  }
  out.put<std::uint64_t>(prior.leads.size());
  for (const core::SurveyLead& l : prior.leads) {
    out.put(l.station);
    out.put(l.noted);
  }
}

/// The body, after a check that the header agrees with it.
FlatReader body_of(std::span<const std::byte> bytes) {
  FlatReader in(bytes);
  if (in.number<std::uint64_t>() != kMagic) in.fail("this is no request");
  if (const auto version = in.number<std::uint32_t>(); version != kVersion)
    in.fail("a request of version " + std::to_string(version) + ", this karst reads version " +
            std::to_string(kVersion));
  in.number<std::uint32_t>();
  const auto length = in.number<std::uint64_t>(), sum = in.number<std::uint64_t>();
  if (length != in.left())
    in.fail("it should hold " + std::to_string(length) + " bytes more, but holds " +
            std::to_string(in.left()));
  if (checksum(bytes.subspan(kHeader)) != sum) in.fail("it is damaged: the sum over its bytes is wrong");
  return in;
}

}  // namespace

Bytes flatten(const core::DecisionRequest& r, std::uint64_t map_since) {
  FlatWriter out;
  out.put(kMagic);
  out.put(kVersion);
  out.put<std::uint32_t>(0);
  out.put<std::uint64_t>(0), out.put<std::uint64_t>(0);
  out.put(r.stamp);
  out.put(r.deadline);
  out.put(r.sequence);
  out.put(r.state.stamp);
  out.put(r.state.position);
  out.put(r.state.velocity_mps);
  out.put(r.state.orientation);
  out.put(r.state.body_rate_radps);
  out.put(r.direction_of_flight);
  out.put(r.T_world_start);
  out.put(r.seconds_before_homing);
  out.put(r.battery_fraction);
  out.put(r.battery_seconds_left);
  out.put(r.mission_seconds_left);
  out.put(r.max_speed_mps);
  out.put(r.max_acceleration_mps2);
  out.put(r.clearance_m);
  out.put(r.vehicle_radius_m);
  out.put(static_cast<std::uint32_t>(r.last_fate));
  out.put(r.last_goal);
  put_vehicle(out, r.vehicle);
  put_frontiers(out, r.frontiers);
  put_teammates(out, r.teammates);
  put_map(out, r, map_since);
  put_imaged(out, r.imaged);
  put_survey(out, r.survey, map_since);
  Bytes bytes = out.take();
  seal(bytes);
  return bytes;
}

void seal(std::span<std::byte> request) {
  const std::uint64_t length = request.size() - kHeader, sum = checksum(request.subspan(kHeader));
  std::memcpy(request.data() + 16, &length, 8);
  std::memcpy(request.data() + 24, &sum, 8);
}

const core::DecisionRequest& RequestReader::read(std::span<const std::byte> bytes) {
  try {
    FlatReader in = body_of(bytes);
    core::DecisionRequest& r = request_;
    r.stamp = in.number<core::TimeNs>();
    r.deadline = in.number<core::TimeNs>();
    r.sequence = in.number<std::uint32_t>();
    r.state.stamp = in.number<core::TimeNs>();
    r.state.position = in.vec3();
    r.state.velocity_mps = in.vec3();
    r.state.orientation = in.quat();
    r.state.body_rate_radps = in.vec3();
    r.direction_of_flight = in.vec3();
    r.T_world_start = in.pose();
    r.seconds_before_homing = in.number<double>();
    r.battery_fraction = in.number<double>();
    r.battery_seconds_left = in.number<double>();
    r.mission_seconds_left = in.number<double>();
    r.max_speed_mps = in.number<double>();
    r.max_acceleration_mps2 = in.number<double>();
    r.clearance_m = in.number<double>();
    r.vehicle_radius_m = in.number<double>();
    r.last_fate = static_cast<core::GoalFate>(
        in.choice(0, static_cast<std::uint32_t>(core::GoalFate::superseded), "the last goal's fate"));
    r.last_goal = in.vec3();
    read_vehicle(in);
    read_frontiers(in);
    read_teammates(in);
    read_map(in);
    read_imaged(in);
    read_survey(in);
    in.require_end();
  } catch (...) {
    request_ = {};
    roadmap_.reset();
    map_.reset();
    survey_.reset();
    throw;
  }
  return request_;
}

void RequestReader::read_vehicle(FlatReader& in) {
  vehicle_ = {};
  request_.vehicle = nullptr;
  if (!in.flag()) return;
  if (in.flag()) vehicle_.lidar = std::make_shared<core::LidarModel>(lidar(in));
  const std::size_t cameras = in.count(1, kMaxSensors, "cameras");
  for (std::size_t i = 0; i < cameras; ++i)
    vehicle_.cameras.push_back(std::make_shared<core::CameraModel>(camera(in)));
  if (in.flag()) {
    const core::CameraModel model = camera(in);
    vehicle_.rgb = std::make_shared<core::RgbCameraModel>(core::RgbCameraModel{model, in.number<double>()});
  }
  request_.vehicle = &vehicle_;
}

void RequestReader::read_imaged(FlatReader& in) {
  request_.imaged = nullptr;
  if (!in.flag()) return;
  std::vector<core::CellKey> cells(in.count(kKeyBytes, kMaxCells, "imaged cells"));
  for (core::CellKey& k : cells) k = key(in);
  imaged_ = core::ImagedSurface(cells);
  request_.imaged = &imaged_;
}

void RequestReader::read_survey(FlatReader& in) {
  request_.survey = nullptr;
  if (!in.flag()) return;
  if (in.flag()) {
    core::SurveyPrior prior;
    prior.stations.resize(in.count(kStationBytes, kMaxStations, "stations"));
    for (core::Vec3& p : prior.stations) p = in.vec3();
    prior.legs.resize(in.count(kLegBytes, kMaxStations, "legs"));
    for (core::SurveyedLeg& l : prior.legs) {
      l.from = in.number<std::uint32_t>();
      l.to = in.number<std::uint32_t>();
      l.from_size = passage_size(in);
      l.to_size = passage_size(in);
    }
    prior.leads.resize(in.count(kLeadBytes, kMaxStations, "leads"));
    for (core::SurveyLead& l : prior.leads) {
      l.station = in.number<std::uint32_t>();
      l.noted = in.flag();
    }
    if (!core::is_sound(prior)) in.fail("the survey is none");
    survey_.emplace(std::move(prior));
  }
  if (!survey_) in.fail("it tells of a survey that came before it, and that is not here");
  request_.survey = &*survey_;
}

void RequestReader::read_frontiers(FlatReader& in) {
  clusters_.clear();
  clusters_.resize(in.count(kClusterBytes, kMaxClusters, "frontier clusters"));
  request_.frontiers.clear();
  for (core::FrontierCluster& c : clusters_) {
    c.id = in.number<std::uint32_t>();
    c.centroid = in.vec3();
    c.low = in.vec3();
    c.high = in.vec3();
    c.normal = in.vec3();
    c.unknown_cells = in.number<std::uint32_t>();
    c.free_cells = in.number<std::uint32_t>();
    core::FrontierOffer offer;
    offer.cluster = &c;
    offer.viewpoint = in.vec3();
    offer.viewpoint_heading_rad = in.number<double>();
    offer.path_length_m = in.number<double>();
    c.cells.resize(in.count(kKeyBytes, kMaxCells, "cells in a cluster"));
    for (core::CellKey& k : c.cells) k = key(in);
    request_.frontiers.push_back(offer);
  }
}

void RequestReader::read_teammates(FlatReader& in) {
  request_.teammates.assign(in.count(kTeammateBytes, kMaxTeammates, "teammates"), {});
  for (core::OtherVehicle& v : request_.teammates) {
    v.id = in.number<std::uint32_t>();
    v.heard = in.number<core::TimeNs>();
    v.position = in.vec3();
    v.velocity_mps = in.vec3();
    if (in.flag()) v.goal = in.vec3();
    v.seconds_before_homing = in.number<double>();
  }
}

void RequestReader::read_map(FlatReader& in) {
  request_.map = nullptr;
  request_.roadmap = nullptr;
  if (!in.flag()) return;
  const auto resolution = in.number<double>();
  if (!(resolution >= 0.001 && resolution <= 100.0)) in.fail("the map's resolution is out of range");
  const auto revision = in.number<std::uint64_t>(), since = in.number<std::uint64_t>();
  if (since != 0 && (!map_ || map_->revision() != since || map_->resolution_m() != resolution))
    in.fail("it tells what changed in a map that came before it, and that is not here");
  if (since == 0) {
    core::MapOptions options;
    options.resolution_m = resolution;
    map_.emplace(options);
    roadmap_.reset();
  }
  std::vector<core::ClassBlock> blocks(in.count(kBlockBytes, kMaxCells, "blocks"));
  for (core::ClassBlock& b : blocks) {
    b.low = key(in);
    std::memcpy(b.classes.data(), in.raw(sizeof b.classes).data(), sizeof b.classes);
    if (!core::is_sound(b)) in.fail("a block of the map is none");
  }
  const std::vector<core::CellChange> changes = core::assign_blocks(*map_, blocks, revision);
  request_.map = &*map_;
  if (!in.flag()) return;
  core::PlanningOptions options;
  options.clearance_m = in.number<double>(), options.search_slack_cells = in.number<double>();
  if (keeps_ == Keeps::map_and_roadmap) update_roadmap(options, changes);
}

void RequestReader::update_roadmap(const core::PlanningOptions& options,
                                   std::span<const core::CellChange> changes) {
  const bool same = roadmap_ && roadmap_->options().clearance_m == options.clearance_m &&
                    roadmap_->options().search_slack_cells == options.search_slack_cells;
  if (same) {
    roadmap_->update(*map_, changes);
  } else {
    std::vector<core::CellChange> all;
    map_->for_each_known([&](const core::CellKey& k, core::Cell c, float) {
      all.push_back({k, core::Cell::unknown, c});
    });
    roadmap_.emplace(options);
    roadmap_->update(*map_, all);
  }
  request_.roadmap = &*roadmap_;
}

}  // namespace karst::host
