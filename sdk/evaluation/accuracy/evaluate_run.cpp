#include "sdk/evaluation/accuracy/evaluate_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/rounded.h"
#include "sdk/evaluation/accuracy/map_error.h"
#include "sdk/evaluation/accuracy/umeyama.h"
#include "sdk/evaluation/page/decimate.h"

namespace karst::evaluation {
namespace {

using core::InputError;
using core::Pose;
using core::to_millionths;
using core::to_thousandths;
using core::Vec3;
using nlohmann::ordered_json;

constexpr std::size_t kMaxPlotted = 1600;
constexpr int kBins = 60;

ordered_json json_of(const ErrorStatistics& s) {
  return {{"count", s.count},
          {"rmse", to_millionths(s.rmse)},
          {"mean", to_millionths(s.mean)},
          {"median", to_millionths(s.median)},
          {"std", to_millionths(s.std)},
          {"min", to_millionths(s.min)},
          {"max", to_millionths(s.max)}};
}
ordered_json json_of(const PoseErrors& e) {
  return {{"translation_m", json_of(statistics_of(e.translation_m))},
          {"rotation_rad", json_of(statistics_of(e.rotation_rad))}};
}
ordered_json json_of(const std::optional<double>& v) {
  return v ? ordered_json(to_millionths(*v)) : ordered_json(nullptr);
}

/// Aligns the estimates with the true trajectory as the options say; returns a description.
ordered_json align(std::vector<PosePair>& pairs, const EvaluateOptions& options) {
  if (!options.align) return {{"kind", "none"}};
  std::vector<Vec3> from, to;
  for (const PosePair& p : pairs) {
    from.push_back(p.estimate.position);
    to.push_back(p.truth.position);
  }
  const auto found = umeyama(from, to, options.scale);
  if (!found) return {{"kind", "none"}, {"reason", "fewer than three poses, or all on a line"}};
  for (PosePair& p : pairs) p.estimate = *found * p.estimate;
  const core::Quat& q = found->T_to_from.orientation;
  const Vec3& t = found->T_to_from.position;
  return {{"kind", options.scale ? "umeyama with scale" : "umeyama"},
          {"scale", to_millionths(found->scale)},
          {"rotation_xyzw",
           {to_millionths(q.x()), to_millionths(q.y()), to_millionths(q.z()), to_millionths(q.w())}},
          {"translation_m", {to_millionths(t.x()), to_millionths(t.y()), to_millionths(t.z())}}};
}

/// The true pose at every estimate; aligns the first poses if the frames differ.
std::vector<PosePair> pairs_for_drift(const std::vector<StampedPose>& truth,
                                      const std::vector<StampedPose>& estimate,
                                      const EvaluateOptions& options) {
  constexpr double kAlways = std::numeric_limits<double>::infinity();
  std::vector<PosePair> pairs = paired_with_truth(truth, estimate, -kAlways, kAlways);
  if (!options.own_frame || !options.align || pairs.empty()) return pairs;
  const Pose T_truth_estimate = pairs.front().truth * pairs.front().estimate.inverse();
  for (PosePair& p : pairs) p.estimate = T_truth_estimate * p.estimate;
  return pairs;
}

/// Every n-th pair, for plots: [t, true x y z, estimated x y z, error].
ordered_json drawn(const std::vector<PosePair>& pairs, double begin_s) {
  ordered_json rows = ordered_json::array();
  const std::size_t stride = pairs.size() / kMaxPlotted + 1;
  for (std::size_t i = 0; i < pairs.size(); i += stride) {
    const Vec3 &a = pairs[i].truth.position, &b = pairs[i].estimate.position;
    rows.push_back({to_thousandths(pairs[i].t_s - begin_s), to_thousandths(a.x()), to_thousandths(a.y()),
                    to_thousandths(a.z()), to_thousandths(b.x()), to_thousandths(b.y()),
                    to_thousandths(b.z()), to_millionths((a - b).norm())});
  }
  return rows;
}

ordered_json curve(const std::vector<PosePair>& pairs, const std::vector<double>& y, double begin_s,
                   double factor) {
  std::vector<double> t;
  for (const PosePair& p : pairs) t.push_back(p.t_s - begin_s);
  const Curve c = decimate(t, y, kMaxPlotted);
  ordered_json points = ordered_json::array();
  for (std::size_t i = 0; i < c.x.size(); ++i)
    points.push_back({to_thousandths(c.x[i]), to_millionths(factor * c.y[i])});
  return points;
}

std::vector<StampedPose> read_kitti(const std::string& file, const std::vector<StampedPose>& stamps) {
  // Columns: the camera's axes in the body frame, x forward, y left, z up.
  Eigen::Matrix3d body_camera;
  body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  std::ifstream in = core::open_input(file, core::kMaxRecordFileBytes);
  std::vector<StampedPose> poses;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line);
    std::array<double, 12> v{};
    std::size_t count = 0;
    while (count < v.size() && words >> v[count]) ++count;
    if (count == 0) continue;
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> T(v.data());
    const Eigen::Matrix3d R = T.leftCols<3>();
    if (count != v.size() || (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3)
      throw InputError(file, "line " + std::to_string(number), "is not the 3x4 matrix of a pose");
    if (poses.size() == stamps.size()) break;
    poses.push_back({stamps[poses.size()].t_s,
                     {body_camera * T.col(3),
                      core::Quat(Eigen::Matrix3d(body_camera * R * body_camera.transpose())).normalized()}});
  }
  if (poses.size() != stamps.size())
    throw InputError(file, "",
                     "holds " + std::to_string(poses.size()) + " poses without stamps; the trajectory has " +
                         std::to_string(stamps.size()));
  return poses;
}

}  // namespace

ordered_json trajectory_evaluation(const std::vector<StampedPose>& truth,
                                   const std::vector<StampedPose>& estimate, const EvaluateOptions& options,
                                   const std::string& truth_file) {
  std::vector<PosePair> pairs = associate(truth, estimate, options.max_difference_s);
  if (pairs.empty())
    throw InputError(truth_file, "",
                     "no stamp lies within " + std::to_string(options.max_difference_s) +
                         " s of one of the trajectory's; see --max-difference");
  ordered_json e;
  e["truth"] = truth_file;
  e["poses"] = estimate.size();
  e["pairs"] = pairs.size();
  e["alignment"] = align(pairs, options);
  const PoseErrors absolute = absolute_errors(pairs);
  e["ape"] = json_of(absolute);
  e["rpe"]["by_distance"] = json_of(relative_errors(pairs, pairs_by_path(pairs, options.delta_m)));
  e["rpe"]["by_distance"]["delta_m"] = options.delta_m;
  e["rpe"]["by_frames"] = json_of(
      relative_errors(pairs, pairs_by_frames(pairs.size(), static_cast<std::size_t>(options.delta_frames))));
  e["rpe"]["by_frames"]["delta_frames"] = options.delta_frames;

  const std::vector<PosePair> raw = pairs_for_drift(truth, estimate, options);
  const double path_m = true_path_m(raw);
  const auto end_m = end_error_m(raw);
  const SegmentDrift segments = segment_drift(raw);
  e["path_length_m"] = to_millionths(path_m);
  e["drift"] = {{"end_error_m", json_of(end_m)},
                {"end_percent", path_m > 0 && end_m ? ordered_json(to_millionths(100 * *end_m / path_m))
                                                    : ordered_json(nullptr)},
                {"segments", segments.segments},
                {"segment_unit_m", segments.unit_m}};
  const bool any = segments.segments > 0;
  e["drift"]["segment_percent"] =
      any ? ordered_json(to_millionths(segments.translation_percent)) : ordered_json(nullptr);
  e["drift"]["segment_rotation_radpm"] =
      any ? ordered_json(to_millionths(segments.rotation_radpm)) : ordered_json(nullptr);
  e["heading_error_rad"] = json_of(heading_rms_rad(raw));

  const double begin_s = estimate.front().t_s;
  e["begin_s"] = begin_s - options.time_origin_s;
  e["plots"] = {{"poses", drawn(pairs, begin_s)},
                {"translation_m", curve(pairs, absolute.translation_m, begin_s, 1)},
                {"rotation_deg", curve(pairs, absolute.rotation_rad, begin_s, 180 / std::numbers::pi)}};
  return e;
}

ordered_json map_evaluation(const std::vector<Vec3>& points, const MapReference& reference) {
  const std::vector<double> errors = map_errors(points, reference.distance_m);
  const ErrorStatistics s = statistics_of(errors);
  ordered_json e{
      {"reference", reference.file}, {"kind", reference.kind}, {"reference_points", reference.points}};
  e["density_per_m2"] = json_of(reference.density_per_m2);
  e["points"] = points.size();
  e["error_m"] = json_of(s);
  // Equal bins up to the 99.5 % quantile of the errors; the last bin includes the rest.
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  const double top = sorted.empty() ? 1 : std::max(0.01, sorted[sorted.size() * 995 / 1000]);
  std::vector<std::size_t> bins(kBins, 0);
  for (const double d : errors) ++bins[static_cast<std::size_t>(std::min(kBins - 1.0, kBins * d / top))];
  e["plots"] = {{"bin_m", to_millionths(top / kBins)}, {"counts", bins}};
  return e;
}

std::vector<StampedPose> read_poses(const std::string& file, const std::vector<StampedPose>& stamps,
                                    std::vector<std::string>& problems) {
  std::string line;
  {
    std::ifstream in = core::open_input(file, core::kMaxRecordFileBytes);
    while (std::getline(in, line) && (line.empty() || line[0] == '#')) continue;
  }
  std::istringstream words(line);
  std::size_t count = 0;
  for (std::string word; words >> word;) ++count;
  if (count == 12 && !stamps.empty()) return read_kitti(file, stamps);
  std::vector<StampedPose> poses = read_tum(file, problems);
  if (poses.empty()) throw InputError(file, "", "holds no pose: expected lines of \"t x y z qx qy qz qw\"");
  return poses;
}

}  // namespace karst::evaluation
