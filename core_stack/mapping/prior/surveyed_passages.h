// The passages that a survey tells of before the flight: legs between stations, and the distances from the
// stations to the walls. The world frame, metres. It is part of the mission, as a caver knows the survey.
//
//           up                         Seen along a leg, a passage is a rectangle around the line between
//        +-------+                     its stations. It goes from the one at the leg's first station to
//   left |   +   | right               the one at its second.
//        +-------+
//           down
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

/// Where a survey gives no distance to a wall.
constexpr double kUnmeasuredWall_m = 1.5;
/// What is farther than this from the surveyed passages counts as not surveyed: a survey measures the walls
/// at its stations only.
constexpr double kBeyondSurvey_m = 1.0;

/// Distances from a station to the walls: left and right of the leg, seen from its first station to its
/// second; up and down vertical.
struct PassageSize {
  double left_m = kUnmeasuredWall_m, right_m = kUnmeasuredWall_m, up_m = kUnmeasuredWall_m,
         down_m = kUnmeasuredWall_m;
};

struct SurveyedLeg {
  std::uint32_t from = 0, to = 0;  // indices of stations, not the same
  PassageSize from_size, to_size;
};

/// A station where the survey ends.
struct SurveyLead {
  std::uint32_t station = 0;
  bool noted = false;  // the surveyor noted that the cave goes on; else it is a dead end or was not looked at
};

struct SurveyPrior {
  std::vector<Vec3> stations;
  std::vector<SurveyedLeg> legs;
  std::vector<SurveyLead> leads;  // by station
};

/// Whether all indices are in range and all numbers finite, as the functions here expect.
bool is_sound(const SurveyPrior& prior);

/// The prior with an index for distances.
class SurveyedPassages {
 public:
  /// `prior` must be sound.
  explicit SurveyedPassages(SurveyPrior prior);

  const SurveyPrior& prior() const { return prior_; }
  /// The signed distance of a point to the nearest passage, negative in it; +infinity if there is no leg.
  ///
  /// The cross-section is that at the nearest point of the leg. Across a leg of inclination i, up and down
  /// count times cos i, and the mean of left and right times sin i: so a shaft is as deep as it is wide.
  /// Where legs meet, each goes on straight for half of its width, which fills bends; elsewhere its end is
  /// flat.
  double distance_m(const Vec3& p) const;

 private:
  /// One end of a tube: distances from the axis to the four sides, in the plane across it, and for how far
  /// the tube goes on beyond.
  struct End {
    double left_m, right_m, up_m, down_m, beyond_m;
  };
  struct Tube {
    Vec3 from, along, left, up;  // unit: along the leg, and across it
    double length_m;
    End at_from, at_to;
    double distance_m(const Vec3& p) const;
  };
  /// A tree of boxes: a leaf holds one tube; the children of the node i are i + 1 and `second`.
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t second = 0;  // 0: a leaf
    std::uint32_t tube = 0;
  };
  void add_tubes();
  void add_nodes(std::uint32_t* begin, std::uint32_t* end);

  SurveyPrior prior_;
  std::vector<Tube> tubes_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // of the tubes
  std::vector<Node> nodes_;
};

}  // namespace karst::core
