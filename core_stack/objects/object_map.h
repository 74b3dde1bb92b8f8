// The objects of interest that a vehicle has found, from its detections.
//
// Each object is a point that does not move. A sighting belongs to the object of its kind that it fits best,
// by Mahalanobis' distance within a gate, and is taken in as a Kalman filter does: for a point at rest that
// is the average of all sightings, weighted by the inverse of their covariances. What fits none may be a new
// object; it counts as found when it was seen a few times. Objects of one kind that come to lie at one place
// are one, unless one image showed both.
//
// Noise of the looks averages out; the vehicle's own error does not, as it is the same in all looks of one
// visit. So it is kept apart, and added to the deviation at the end.
#pragma once
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core_stack/objects/object_options.h"
#include "core_stack/objects/object_state.h"
#include "core_stack/objects/sighting.h"

namespace karst::core {

struct FoundObject {
  std::uint32_t number = 0;  // from 1, in the order in which they were confirmed
  ObjectKind kind = ObjectKind::none;
  Vec3 position = Vec3::Zero();  // world frame
  double deviation_m = 0;        // root of the squared distance to be expected
  std::uint32_t sightings = 0;
  TimeNs first_seen = 0, last_seen = 0;
};

/// News of an object since its last report.
struct ObjectNews {
  ObjectState state = ObjectState::found;
  FoundObject object;
};

class ObjectMap {
 public:
  explicit ObjectMap(const ObjectOptions& options) : options_(options) {}

  /// One look. `position_sigma_m` is the deviation of the vehicle's own position in each axis.
  void note(const ObjectDetections& look, const Pose& T_world_camera, double position_sigma_m);
  /// The confirmed ones, by number.
  std::vector<FoundObject> objects() const;
  /// Confirmed or withdrawn since the last call, or much better known than when last told; with `all`
  /// whatever is known better at all.
  std::vector<ObjectNews> take_news(TimeNs now, bool all = false);

 private:
  struct Track {
    std::uint32_t id = 0, number = 0;  // number 0: not confirmed
    ObjectKind kind = ObjectKind::none;
    Vec3 position = Vec3::Zero();
    Mat3 covariance = Mat3::Identity();  // of the looks
    double own_variance_m2 = 0;          // of the vehicle's position, mean over the looks, in each axis
    std::uint32_t sightings = 0;
    TimeNs first_seen = 0, last_seen = 0;
    std::optional<FoundObject> reported;
    TimeNs reported_at = 0;
  };

  FoundObject found(const Track& t) const;
  double misfit2(const Track& t, const Vec3& position, const Mat3& covariance) const;
  Track* best_fit(const Sighting& s, const std::set<std::uint32_t>& taken);
  void merge_into(Track& kept);
  bool worth_telling(const Track& t, TimeNs now, bool all) const;

  ObjectOptions options_;
  std::vector<Track> tracks_;                                // by id
  std::set<std::pair<std::uint32_t, std::uint32_t>> apart_;  // ids seen in one image, the lower first
  std::vector<ObjectNews> withdrawn_;
  std::uint32_t next_id_ = 1, next_number_ = 1;
};

}  // namespace karst::core
