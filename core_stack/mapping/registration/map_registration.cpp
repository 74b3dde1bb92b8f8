#include "core_stack/mapping/registration/map_registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core_stack/common/format_text.h"

namespace karst::core {
namespace {

struct Candidate {
  Pose T_target_source;
  Overlay overlay;
  std::optional<double> surface_residual_m = {};
};

/// A rival's surfaces may lie this much farther apart than those of the best pose, whatever the limit.
constexpr double kRefutedRatio = 2;

double tilt_of(const Pose& T) {
  return std::acos(std::clamp((T.orientation * Vec3::UnitZ()).z(), -1.0, 1.0));
}

Vec3 middle_of(const MapPiece& piece) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3f& p : piece.surface) sum += p.cast<double>();
  return sum / static_cast<double>(piece.surface.size());
}

bool same_pose(const Candidate& a, const Candidate& b, const Vec3& middle, double cell_m) {
  return alike(a.T_target_source, b.T_target_source, middle, 5 * cell_m, 0.1);
}

/// The best candidates by score, best first, one for each distinct pose.
std::vector<Candidate> distinct_best(std::vector<Candidate> all, std::size_t most, const Vec3& middle,
                                     double cell_m) {
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return a.overlay.score() > b.overlay.score();
  });
  std::vector<Candidate> kept;
  for (const Candidate& c : all) {
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const Candidate& k) { return same_pose(c, k, middle, cell_m); });
    if (!known) kept.push_back(c);
    if (kept.size() == most) break;
  }
  return kept;
}

/// Whether a pose is no rival of the best one: its own surfaces lie apart.
bool refuted(const Candidate& c, const Candidate& best, const RegistrationLimits& limits, double cell_m) {
  return c.surface_residual_m && best.surface_residual_m &&
         *c.surface_residual_m > limits.max_surface_residual_cells * cell_m &&
         *c.surface_residual_m > kRefutedRatio * *best.surface_residual_m;
}

/// A figure and the limit that it breaks, with as few decimals as show that they differ.
struct Broken {
  std::string figure, limit;
};
Broken broken(double figure, double limit) {
  Broken b;
  for (int decimals = 1; decimals <= 6; ++decimals) {
    b = {format_text("%.*f", decimals, figure), format_text("%.*f", decimals, limit)};
    if (b.figure != b.limit) break;
  }
  return b;
}

/// The reason to reject the registration; empty if there is none.
std::string objection(const MapRegistration& r, double cell_m, bool free_known,
                      const MapRegistrationOptions& options) {
  const RegistrationLimits& limits = options.limits;
  // Two more degrees of freedom make accidental fits more likely.
  const double needed = options.coarse.gravity_known ? 1.0 : 1.5;
  const double min_overlap = needed * (free_known ? limits.min_overlap : limits.min_overlap_blind);
  if (r.overlay.overlap() < min_overlap) {
    const Broken b = broken(100 * r.overlay.overlap(), 100 * min_overlap);
    return "only " + b.figure + " % of the rock coincides; at least " + b.limit + " % must" +
           (free_known ? "" : " where no free space is known");
  }
  if (r.shared_m2 < limits.min_shared_m2) {
    const Broken b = broken(r.shared_m2, limits.min_shared_m2);
    return "only " + b.figure + " m^2 of rock coincide; at least " + b.limit + " m^2 must";
  }
  if (r.overlay.agreement() < limits.min_agreement) {
    const Broken b = broken(100 * (1 - r.overlay.agreement()), 100 * (1 - limits.min_agreement));
    return b.figure + " % of the rock stands in space the other map knows to be free; at most " + b.limit +
           " % may";
  }
  if (const double limit_m = limits.max_residual_cells * cell_m; r.overlay.residual_m() > limit_m) {
    const Broken b = broken(100 * r.overlay.residual_m(), 100 * limit_m);
    return "the residual is " + b.figure + " cm; at most " + b.limit + " cm may remain";
  }
  if (const double limit_m = limits.max_surface_residual_cells * cell_m;
      r.surface_residual_m.value_or(0) > limit_m) {
    const Broken b = broken(100 * *r.surface_residual_m, 100 * limit_m);
    return "the surfaces of the rock lie " + b.figure + " cm apart; at most " + b.limit + " cm may remain";
  }
  if (options.coarse.gravity_known && tilt_of(r.T_target_source) > limits.max_tilt_rad)
    return format_text(
        "the maps would be tilted against each other by %.1f deg, though both know where up is",
        tilt_of(r.T_target_source) * 180 / std::numbers::pi);
  if (r.hold < limits.min_hold)
    return format_text(
        "the rock that coincides leaves a direction free, as a smooth tube does (hold %.3f; at least %.3f)",
        r.hold, limits.min_hold);
  if (r.rival > limits.max_rival) {
    const Broken b = broken(100 * r.rival, 100 * limits.max_rival);
    return "another pose fits nearly as well (" + b.figure + " % as good; at most " + b.limit + " % may be)";
  }
  return "";
}

}  // namespace

void describe(OptionTable& t, RegistrationLimits& o) {
  t.add("min_overlap", o.min_overlap, "", 0, 1,
        "share of one map's rock that must coincide with the other's");
  t.add("min_overlap_blind", o.min_overlap_blind, "", 0, 1,
        "the same where the maps are clouds, without free space");
  t.add("min_shared_area", o.min_shared_m2, "", 0, 1e6, "square metres of rock that must coincide");
  t.add("min_agreement", o.min_agreement, "", 0, 1,
        "of the rock that the other map has seen, the share that must be rock there, too");
  t.add("max_residual", o.max_residual_cells, "", 0, 10,
        "root mean square distance of coinciding rock, in cells of the coarser map");
  t.add("min_hold", o.min_hold, "", 0, 1,
        "least mean squared cosine between a direction and the coinciding rock's normals");
  t.add("max_rival", o.max_rival, "", 0, 1, "score of the next best pose, in parts of the best's");
  t.add("max_tilt", o.max_tilt_rad, "rad", 0, 3.2, "between the maps' vertical axes, if both are known");
}

double hold_of(const MapPiece& target, const MapPiece& source, const Pose& T_target_source, double near_m,
               bool gravity_known) {
  struct Contact {
    Vec3 p, n;
  };
  std::vector<Contact> contacts;
  Vec3 middle = Vec3::Zero();
  const std::size_t stride = source.surface.size() / 20000 + 1;
  for (std::size_t i = 0; i < source.surface.size(); i += stride) {
    const Vec3 p = T_target_source * source.surface[i].cast<double>();
    const auto nearest = target.tree->nearest(p);
    if (nearest->distance_m > near_m) continue;
    contacts.push_back({p, target.normals[nearest->index].cast<double>()});
    middle += p;
  }
  if (contacts.size() < 6) return 0;
  const double n = static_cast<double>(contacts.size());
  middle /= n;
  double arms_m2 = 0;
  for (const Contact& c : contacts) arms_m2 += (c.p - middle).squaredNorm() / n;
  const double arm_m = std::sqrt(std::max(arms_m2, 1e-12));
  Eigen::Matrix<double, 6, 6> held = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Contact& c : contacts) {
    Eigen::Matrix<double, 6, 1> j;
    j << c.n, (c.p - middle).cross(c.n) / arm_m;
    held += j * j.transpose() / n;
  }
  if (!gravity_known)
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(held).eigenvalues()[0];
  Eigen::Matrix4d upright;
  upright << held.topLeftCorner<3, 3>(), held.block<3, 1>(0, 5), held.block<1, 3>(5, 0), held(5, 5);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(upright).eigenvalues()[0];
}

MapRegistration register_maps(const MapPiece& target, const MapPiece& source,
                              const MapRegistrationOptions& options, const RefinePose& refine,
                              const FinishPose& finish) {
  const double cell_m = std::max(target.resolution_m, source.resolution_m);
  const bool free_known = target.knows_free_space() || source.knows_free_space();
  MapRegistration result;
  const std::vector<CoarsePose> coarse = coarse_poses(target, source, options.coarse);
  if (coarse.empty()) {
    result.reason = "the maps show too little rock to find places that look alike";
    return result;
  }
  const Vec3 middle = middle_of(source);
  OverlayOptions glance = options.overlay;
  glance.max_points = 2000;
  std::vector<Candidate> candidates;
  for (const CoarsePose& c : coarse) {
    const Pose T = refine(source, c.T_target_source, options.quick);
    candidates.push_back({T, overlay(target, source, T, glance)});
  }
  candidates = distinct_best(std::move(candidates), options.finalists, middle, cell_m);
  for (Candidate& c : candidates) {
    c.T_target_source = refine(source, c.T_target_source, options.thorough);
    if (finish) {
      const FinishedPose finished = finish(c.T_target_source);
      c.T_target_source = finished.T_target_source;
      c.surface_residual_m = finished.surface_residual_m;
    }
    c.overlay = overlay(target, source, c.T_target_source, options.overlay);
  }
  const auto best = std::max_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.overlay.score() < b.overlay.score();
  });
  result.T_target_source = best->T_target_source;
  result.overlay = best->overlay;
  result.surface_residual_m = best->surface_residual_m;
  const double near_m = options.overlay.near_cells * cell_m;
  result.hold = hold_of(target, source, best->T_target_source, near_m, options.coarse.gravity_known);
  result.shared_m2 = best->overlay.source_overlap() * static_cast<double>(source.surface.size()) *
                     source.resolution_m * source.resolution_m;
  double rival = 0;
  for (const Candidate& c : candidates)
    if (!same_pose(c, *best, middle, cell_m) && !refuted(c, *best, options.limits, cell_m))
      rival = std::max(rival, c.overlay.score());
  result.rival = best->overlay.score() > 0 ? rival / best->overlay.score() : 1;
  result.reason = objection(result, cell_m, free_known, options);
  result.trusted = result.reason.empty();
  return result;
}

}  // namespace karst::core
