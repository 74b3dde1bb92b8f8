// The surface that is not imaged yet: from the host's record, or from the policy's own if there is none.
#pragma once
#include <karst/imaged.h>

#include <memory>
#include <set>
#include <tuple>
#include <vector>

namespace surface_coverage {

using karst::Box;
using karst::distance;
using karst::ImagingCamera;
using karst::SurfaceCell;
using karst::Vec3;
using karst::Viewpoint;

constexpr double kPi = 3.14159265358979323846, kDegree = kPi / 180;

/// A map cell, identified by the position of its centre; the map's own indices are not known here.
struct CellId {
  long x = 0, y = 0, z = 0;
  bool operator<(const CellId& o) const { return std::tie(x, y, z) < std::tie(o.x, o.y, o.z); }
};
CellId cell_id(const Vec3& center, double resolution_m);

/// The imaged surface at the time of one request.
class Account {
 public:
  virtual ~Account() = default;
  virtual const ImagingCamera& camera() const = 0;
  virtual std::vector<SurfaceCell> unimaged(const Box& box) const = 0;
  /// For each viewpoint, the centres of the cells that a picture from it would add.
  virtual std::vector<std::vector<Vec3>> looks(const std::vector<Viewpoint>& from) const = 0;
};

/// Records the cells that pictures taken at the poses of decisions must have shown. Coarser than the core's
/// record: it misses pictures between decisions, and a normal is the mean of a cell's free face neighbours.
class OwnMemory {
 public:
  /// The account at `request`, valid while its decide() runs.
  std::unique_ptr<Account> update(const karst::Request& request);

 private:
  friend class OwnAccount;
  std::set<CellId> imaged_;
};

/// The host's account; null if it keeps none.
std::unique_ptr<Account> host_account(const karst::Request& request);

/// The colour camera among the sensors; without one, 80 x 64 degrees forward, 6 m.
ImagingCamera camera_of(const karst::Request& request);

}  // namespace surface_coverage
