#include "core_stack/mapping/registration/coarse_match.h"

#include <algorithm>
#include <numeric>

#include "core_stack/mapping/obstacles/thinned_out.h"
#include "core_stack/mapping/registration/map_overlay.h"

namespace karst::core {
namespace {

constexpr double kThin_m = 0.4;        // spacing of the points for descriptors
constexpr double kRough_m = 0.4;       // cells of the quick score: rock counts as thickened to 1.2 m
constexpr std::size_t kScored = 1500;  // number of source points for the quick score
constexpr int kMinPoints = 60;         // a place with less rock around it is not distinctive

struct Places {
  std::vector<PlaceFrame> frames;
  std::vector<PlaceDescriptor> descriptors;
};

/// Any rotation that turns the z axis to `axis`.
Quat axis_frame(const Vec3& axis) { return Quat::FromTwoVectors(Vec3::UnitZ(), axis).normalized(); }

/// The axes of the places: up, or the place's normal, or the normal in both directions.
enum class Axes { up, normal, both_normals };

/// Rock points about `spacing_m` apart with their axes.
std::vector<PlaceFrame> frames_of(const MapPiece& piece, double spacing_m, Axes axes) {
  std::vector<PlaceFrame> frames;
  for (const Vec3f& p : thinned_out(piece.surface, spacing_m)) {
    const std::uint32_t i = piece.tree->nearest(p.cast<double>())->index;
    const Vec3 position = piece.surface[i].cast<double>();
    if (axes == Axes::up) {
      frames.push_back({position, Quat::Identity()});
      continue;
    }
    const Vec3 normal = piece.normals[i].cast<double>();
    frames.push_back({position, axis_frame(normal)});
    if (axes == Axes::both_normals) frames.push_back({position, axis_frame(-normal)});
  }
  return frames;
}

Places places_of(const MapPiece& piece, double cell_m, double spacing_m, std::size_t most, Axes axes) {
  std::vector<PlaceFrame> frames = frames_of(piece, spacing_m, axes);
  for (; frames.size() > 4 * most; frames = frames_of(piece, spacing_m, axes)) spacing_m *= 1.5;
  const PointTree thin(thinned_out(piece.surface, kThin_m));
  Places places;
  const double stride = std::max(1.0, static_cast<double>(frames.size()) / static_cast<double>(most));
  for (double at = 0; at < static_cast<double>(frames.size()); at += stride) {
    const PlaceFrame& f = frames[static_cast<std::size_t>(at)];
    PlaceDescriptor d(thin, f, cell_m);
    if (d.count() < kMinPoints) continue;
    places.frames.push_back(f);
    places.descriptors.push_back(std::move(d));
  }
  return places;
}

using Invariants = Eigen::Matrix<float, PlaceDescriptor::kInvariants, Eigen::Dynamic>;
Invariants stacked(const Places& places) {
  Invariants all(PlaceDescriptor::kInvariants, static_cast<Eigen::Index>(places.frames.size()));
  for (std::size_t i = 0; i < places.frames.size(); ++i)
    all.col(static_cast<Eigen::Index>(i)) = places.descriptors[i].invariants();
  return all;
}

/// Indices of the `count` largest entries, largest first; of equal ones the lower index first.
std::vector<std::size_t> largest(const Eigen::VectorXf& values, std::size_t count) {
  std::vector<std::size_t> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  count = std::min(count, order.size());
  const auto more = [&](std::size_t a, std::size_t b) {
    const float va = values[static_cast<Eigen::Index>(a)], vb = values[static_cast<Eigen::Index>(b)];
    return va != vb ? va > vb : a < b;
  };
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), more);
  order.resize(count);
  return order;
}

/// For each match of two places, the pose of the whole map that it implies.
std::vector<Pose> matched_poses(const MapPiece& target, const MapPiece& source, double cell_m,
                                const CoarseOptions& options) {
  // Where free space is unknown the sign of a normal is unknown, too; one side of the pair tries both.
  const bool sign_known = target.knows_free_space() && source.knows_free_space();
  const Axes to_axes = options.gravity_known ? Axes::up : Axes::normal;
  const Axes from_axes = options.gravity_known ? Axes::up : sign_known ? Axes::normal : Axes::both_normals;
  const Places to = places_of(target, cell_m, options.spacing_m, options.max_target_places, to_axes);
  const Places from =
      places_of(source, cell_m, 1.5 * options.spacing_m, options.max_source_places, from_axes);
  if (to.frames.empty() || from.frames.empty()) return {};
  const Invariants to_all = stacked(to);
  std::vector<Pose> poses;
  for (std::size_t s = 0; s < from.frames.size(); ++s) {
    const Eigen::VectorXf likeness = to_all.transpose() * from.descriptors[s].invariants();
    for (const std::size_t t : largest(likeness, options.candidates)) {
      const double turn = to.descriptors[t].turn_of(from.descriptors[s]).angle_rad;
      const Quat R = (to.frames[t].orientation * from_heading(turn) * from.frames[s].orientation.conjugate())
                         .normalized();
      poses.push_back({to.frames[t].position - R * from.frames[s].position, R});
    }
  }
  return poses;
}

}  // namespace

bool alike(const Pose& a, const Pose& b, const Vec3& middle, double metres, double radians) {
  return (a * middle - b * middle).norm() < metres && a.orientation.angularDistance(b.orientation) < radians;
}

std::vector<CoarsePose> coarse_poses(const MapPiece& target, const MapPiece& source,
                                     const CoarseOptions& options) {
  const RoughTarget rough(target, std::max(kRough_m, 2 * target.resolution_m));
  std::vector<Vec3> sample;
  const std::size_t stride = source.surface.size() / kScored + 1;
  for (std::size_t i = 0; i < source.surface.size(); i += stride)
    sample.push_back(source.surface[i].cast<double>());

  std::vector<CoarsePose> poses;
  for (const double cell_m : options.cells_m)
    for (const Pose& T : matched_poses(target, source, cell_m, options))
      poses.push_back({T, rough.score(sample, T)});
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });

  const Vec3 middle =
      std::accumulate(sample.begin(), sample.end(), Vec3(Vec3::Zero())) / static_cast<double>(sample.size());
  // Merges equal poses and counts their votes. The rock of a small overlap scores less than walls laid on
  // unrelated walls, but its matches agree with each other.
  std::vector<CoarsePose> distinct;
  for (const CoarsePose& p : poses) {
    const auto known = std::find_if(distinct.begin(), distinct.end(), [&](const CoarsePose& k) {
      return alike(p.T_target_source, k.T_target_source, middle, options.distinct_m, options.distinct_rad);
    });
    if (known != distinct.end()) {
      ++known->votes;
    } else {
      distinct.push_back(p);
    }
  }
  const std::size_t by_score = std::min(distinct.size(), options.kept / 2);
  const auto rest = distinct.begin() + static_cast<std::ptrdiff_t>(by_score);
  std::stable_sort(rest, distinct.end(), [](const auto& a, const auto& b) { return a.votes > b.votes; });
  distinct.resize(std::min(distinct.size(), options.kept));
  return distinct;
}

}  // namespace karst::core
