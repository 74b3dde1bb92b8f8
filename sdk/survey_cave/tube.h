// The passage along one leg: a tube whose outline goes from that at one station to that at the other.
#pragma once
#include <cstdint>

#include "sdk/survey_cave/outline.h"

namespace karst::survey_cave {

/// One end of a tube, and the plane of its cross-section.
struct TubeEnd {
  core::Vec3 centre = core::Vec3::Zero();   // of the station
  core::Vec3 normal = core::Vec3::UnitX();  // unit, along the tube from its first end to its second
  core::Vec3 left = core::Vec3::UnitY();    // unit, in the plane: the outline's x; its y is normal x left
  Outline outline;
  bool open = false;   // another tube goes on in the same plane
  double cap_m = 0.5;  // else the passage is closed, rounded, so far beyond the plane
};

/// The signed distance to a tube, negative in it.
///
/// The outline at t in 0..1 is from + t (to - from), corner by corner, in the plane through a + t (b - a)
/// with the normal (1 - t) n_a / (d n_a) + t n_b / (d n_b), where d is the unit vector from station a to b:
/// the planes of both ends, and in between one through each point of the centre line.
class Tube {
 public:
  /// The ends must be apart, and both normals have a positive component along the tube.
  Tube(const TubeEnd& from, const TubeEnd& to, std::uint32_t leg, std::uint32_t passage);

  /// At most the true distance, and exact to first order at walls that are parallel to the centre line.
  double distance(const core::Vec3& p) const;
  /// At most the true distance outside; cheap.
  double far_distance(const core::Vec3& p) const;
  /// At most the true distance outside, also where the passage widens quickly; if it is more than `enough_m`,
  /// it may be anything between that and the true one.
  double least_distance(const core::Vec3& p, double enough_m) const;
  /// Whether all points within the radius of p are certainly in the tube.
  bool holds_ball(const core::Vec3& p, double radius_m) const;

  const TubeEnd& from() const { return from_; }
  const TubeEnd& to() const { return to_; }
  double length_m() const { return length_m_; }
  double reach_m() const { return reach_m_; }  // greatest distance of the wall from the centre line
  std::uint32_t leg() const { return leg_; }   // index into Survey::legs
  /// Tubes of one passage follow each other, and share the planes of their open ends.
  std::uint32_t passage() const { return passage_; }

  /// Width and height at t, as seen along the tube.
  Vec2 size_at(double t) const;
  /// In the middle of the outline at t.
  core::Vec3 middle_at(double t) const;

 private:
  struct Frame {
    core::Vec3 normal, left, up;
  };
  Frame frame_at(double t) const;
  double at_end(const core::Vec3& p, bool second) const;

  TubeEnd from_, to_;
  core::Vec3 axis_;
  double length_m_, reach_m_;
  core::Vec3 from_gradient_, to_gradient_;  // normals over their components along the axis
  double slope_;                            // greatest change of the distance in metres a metre
  std::uint32_t leg_, passage_;
};

}  // namespace karst::survey_cave
