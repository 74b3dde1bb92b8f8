#include "core_stack/loops/submap.h"

#include <algorithm>
#include <cmath>

#include "core_stack/mapping/obstacles/thinned_out.h"

namespace karst::core {
namespace {

constexpr double kThin_m = 0.5;  // spacing of the points for descriptors
constexpr int kMinPoints = 60;   // around a place: with less rock it is not distinctive
constexpr int kMeanShifts = 4;
constexpr double kMiddle_m = 6;   // radius of the rock whose middle a place is
constexpr float kPerMetre = 100;  // packed coordinates

Vec3 middle_of_rock(const PointTree& thin, Vec3 p) {
  for (int i = 0; i < kMeanShifts; ++i) {
    const std::vector<std::uint32_t> around = thin.within(p, kMiddle_m);
    if (around.empty()) break;
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t k : around) sum += thin.points()[k].cast<double>();
    p = sum / static_cast<double>(around.size());
  }
  return p;
}

}  // namespace

void describe(OptionTable& t, SubmapOptions& o) {
  t.add("length", o.length_m, "m", 1, 50, "path in one submap");
  t.add("keyframe", o.keyframe_m, "m", 0.05, 5, "path between sweeps that are added");
  t.add("range", o.range_m, "m", 3, 100, "farther points are left out");
  t.add("voxel", o.voxel_m, "m", 0.05, 1, "one point is kept in each");
  t.add("place_distance", o.place_distance_m, "m", 0.2, 20, "path between described places");
  t.add("place_cell", o.place_cell_m, "m", 0.3, 10, "width of a descriptor's rings");
}

std::vector<Vec3f> Submap::points() const {
  std::vector<Vec3f> out;
  out.reserve(packed.size());
  for (const auto& p : packed)
    out.emplace_back(Vec3f(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])) /
                     kPerMetre);
  return out;
}

std::size_t Submap::bytes() const {
  return sizeof(Submap) + packed.capacity() * sizeof(packed[0]) + flown.capacity() * sizeof(Vec3f) +
         places.capacity() * sizeof(Place);
}

std::vector<std::array<std::int16_t, 3>> packed(const std::vector<Vec3f>& points) {
  std::vector<std::array<std::int16_t, 3>> out;
  out.reserve(points.size());
  for (const Vec3f& p : points) {
    const Vec3f scaled = kPerMetre * p;
    if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() >= 32767) continue;
    out.push_back({static_cast<std::int16_t>(std::lround(scaled.x())),
                   static_cast<std::int16_t>(std::lround(scaled.y())),
                   static_cast<std::int16_t>(std::lround(scaled.z()))});
  }
  return out;
}

std::vector<Place> described_places(const std::vector<Vec3f>& points, const std::vector<Vec3f>& flown,
                                    const SubmapOptions& options) {
  std::vector<Place> places;
  const PointTree thin(thinned_out(points, kThin_m));
  double since_m = options.place_distance_m;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    if (i > 0) since_m += static_cast<double>((flown[i] - flown[i - 1]).norm());
    if (since_m < options.place_distance_m) continue;
    since_m = 0;
    const Vec3 position = middle_of_rock(thin, flown[i].cast<double>());
    PlaceDescriptor descriptor(thin, {position, Quat::Identity()}, options.place_cell_m);
    if (descriptor.count() >= kMinPoints) places.push_back({position, descriptor});
  }
  return places;
}

std::optional<Submap> SubmapBuilder::add(const Seen& seen) {
  const Vec3& position = seen.T_world_body.position;
  const double moved_m = last_ ? (position - *last_).norm() : 0;
  last_ = position;
  path_m_ += moved_m;
  uncertainty_m_ += seen.further_uncertainty_m;
  std::optional<Submap> complete;
  if (open_ && path_m_ - open_->path_begin_m >= options_.length_m) complete = completed();
  if (!open_) {
    open_.emplace();
    open_->T_world_submap = {position, from_heading(heading_of(seen.T_world_body.orientation))};
    open_->T_submap_body = open_->T_world_submap.inverse() * seen.T_world_body;
    open_->first = open_->last = seen.stamp;
    open_->path_begin_m = path_m_;
    open_->uncertainty_m = uncertainty_m_;
  } else if (path_m_ - keyframe_path_m_ < options_.keyframe_m) {
    open_->observed = open_->observed && seen.observed;
    open_->last = seen.stamp;
    open_->path_end_m = path_m_;
    return complete;
  }
  keyframe_path_m_ = path_m_;
  open_->last = seen.stamp;
  open_->path_end_m = path_m_;
  open_->observed = open_->observed && seen.observed;
  const Pose T_submap_world = open_->T_world_submap.inverse();
  open_->flown.push_back((T_submap_world * position).cast<float>());
  for (const Vec3f& p : *seen.points_world)
    if ((p.cast<double>() - position).norm() <= options_.range_m)
      points_.push_back((T_submap_world * p.cast<double>()).cast<float>());
  return complete;
}

Submap SubmapBuilder::completed() {
  Submap done = std::move(*open_);
  open_.reset();
  const std::vector<Vec3f> thin = thinned_out(points_, options_.voxel_m);
  points_.clear();
  done.places = described_places(thin, done.flown, options_);
  done.packed = packed(thin);
  return done;
}

std::optional<Submap> SubmapBuilder::finish() {
  if (!open_) return std::nullopt;
  return completed();
}

}  // namespace karst::core
