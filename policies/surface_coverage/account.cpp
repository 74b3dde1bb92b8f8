#include "account.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace surface_coverage {
namespace {

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3 rotated(const karst_quaternion_t& q, const Vec3& v) {
  const Vec3 u{q.x, q.y, q.z}, t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
karst_quaternion_t inverse(const karst_quaternion_t& q) { return {q.w, -q.x, -q.y, -q.z}; }
karst_quaternion_t about_z(double heading_rad) {
  return {std::cos(heading_rad / 2), 0, 0, std::sin(heading_rad / 2)};
}

class HostAccount final : public Account {
 public:
  explicit HostAccount(const karst::ImagedView& view) : view_(view) {}
  const ImagingCamera& camera() const override { return view_.camera(); }
  std::vector<SurfaceCell> unimaged(const Box& box) const override { return view_.unimaged(box); }
  std::vector<std::vector<Vec3>> looks(const std::vector<Viewpoint>& from) const override {
    return view_.newly_imaged_cells(from);
  }

 private:
  karst::ImagedView view_;
};

}  // namespace

CellId cell_id(const Vec3& center, double resolution_m) {
  const auto id = [&](double v) { return std::lround(std::floor(v / resolution_m)); };
  return {id(center.x), id(center.y), id(center.z)};
}

ImagingCamera camera_of(const karst::Request& request) {
  ImagingCamera camera{};
  camera.max_incidence_rad = 70 * kDegree;
  camera.period_s = 0.5;
  for (const karst::Sensor& s : request.sensors)
    if (s.kind == KARST_SENSOR_RGB) {
      camera.sensor = s;
      return camera;
    }
  camera.sensor.kind = KARST_SENSOR_RGB;
  camera.sensor.T_body_sensor.orientation.w = 1;
  camera.sensor.min_range_m = 0.3;
  camera.sensor.max_range_m = 6;
  camera.sensor.horizontal_fov_rad = 80 * kDegree;
  camera.sensor.low_elevation_rad = -32 * kDegree;
  camera.sensor.high_elevation_rad = 32 * kDegree;
  return camera;
}

std::unique_ptr<Account> host_account(const karst::Request& request) {
  auto view = karst::ImagedView::of(request.host());
  return view ? std::make_unique<HostAccount>(*view) : nullptr;
}

class OwnAccount final : public Account {
 public:
  OwnAccount(const karst::Request& request, const OwnMemory& memory)
      : request_(request),
        memory_(memory),
        camera_(camera_of(request)),
        resolution_m_(request.map.resolution_m()) {}

  const ImagingCamera& camera() const override { return camera_; }

  /// In the order of the map's surface(): by z, then y, then x.
  std::vector<SurfaceCell> unimaged(const Box& box) const override {
    if (!holds(known_box_, box)) read_around(box);
    // The cells whose centre lies in the box, as the host counts them.
    const auto first = [&](double v) { return std::lround(std::ceil(v / resolution_m_ - 0.5)); };
    const auto last = [&](double v) { return std::lround(std::floor(v / resolution_m_ - 0.5)); };
    const CellId low{first(box.low.x), first(box.low.y), first(box.low.z)},
        high{last(box.high.x), last(box.high.y), last(box.high.z)};
    std::vector<SurfaceCell> out;
    const auto row_before = [](const KnownCell& c, const CellId& k) {
      return std::tie(c.id.z, c.id.y) < std::tie(k.z, k.y);
    };
    auto at = known_.begin();
    for (long z = low.z; z <= high.z && at != known_.end(); ++z) {
      at = std::lower_bound(at, known_.end(), CellId{0, low.y, z}, row_before);
      for (; at != known_.end() && at->id.z == z && at->id.y <= high.y; ++at)
        if (at->id.x >= low.x && at->id.x <= high.x) out.push_back(at->cell);
    }
    return out;
  }

  std::vector<std::vector<Vec3>> looks(const std::vector<Viewpoint>& from) const override {
    std::vector<std::vector<Vec3>> out;
    for (const Viewpoint& v : from) out.push_back(seen(v.position, about_z(v.heading_rad)));
    return out;
  }

  /// The cells not imaged yet that a picture from this body pose would show.
  std::vector<Vec3> seen(const Vec3& position, const karst_quaternion_t& q_world_body) const {
    const karst::Sensor& s = camera_.sensor;
    const Vec3 eye = position + rotated(q_world_body, s.T_body_sensor.position);
    std::vector<SurfaceCell> cells;
    std::vector<karst_segment_t> rays;
    for (const SurfaceCell& c : unimaged(karst::box_around(eye, s.max_range_m))) {
      const Vec3 place = Vec3(c.center) + 0.6 * resolution_m_ * Vec3(c.normal), away = place - eye;
      const double range = norm(away);
      if (range < s.min_range_m || range > s.max_range_m) continue;
      if (-dot(away, c.normal) < std::cos(camera_.max_incidence_rad) * range) continue;
      const Vec3 p = rotated(inverse(s.T_body_sensor.orientation), rotated(inverse(q_world_body), away));
      if (p.x <= 0 || std::abs(p.y) > p.x * std::tan(s.horizontal_fov_rad / 2)) continue;
      if (p.z < p.x * std::tan(s.low_elevation_rad) || p.z > p.x * std::tan(s.high_elevation_rad)) continue;
      cells.push_back(c);
      rays.push_back({eye, place});
    }
    std::vector<Vec3> out;
    const auto ends = request_.map.cast(rays, false);
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (ends[i].state == KARST_CELL_FREE) out.push_back(cells[i].center);
    return out;
  }

 private:
  struct KnownCell {
    CellId id;
    SurfaceCell cell;
  };

  static bool holds(const Box& outer, const Box& inner) {
    return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
           outer.high.x >= inner.high.x && outer.high.y >= inner.high.y && outer.high.z >= inner.high.z;
  }

  /// Hundreds of looks in a decision overlap: what is not imaged is read once for all of them.
  void read_around(const Box& box) const {
    const double margin_m = 2 * camera_.sensor.max_range_m;
    const Vec3 margin{margin_m, margin_m, margin_m};
    Box all{box.low - margin, box.high + margin};
    if (known_box_.low.x <= known_box_.high.x) {
      all.low = {std::min(all.low.x, known_box_.low.x), std::min(all.low.y, known_box_.low.y),
                 std::min(all.low.z, known_box_.low.z)};
      all.high = {std::max(all.high.x, known_box_.high.x), std::max(all.high.y, known_box_.high.y),
                  std::max(all.high.z, known_box_.high.z)};
    }
    known_box_ = all;
    known_.clear();
    for (const SurfaceCell& c : surface(all))
      if (const CellId id = cell_id(c.center, resolution_m_); memory_.imaged_.count(id) == 0)
        known_.push_back({id, c});
  }

  std::vector<SurfaceCell> surface(const Box& box) const {
    static constexpr int kFaces[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    const std::vector<Vec3> centers = request_.map.surface(box);
    std::vector<Vec3> beside;
    for (const Vec3& c : centers)
      for (const auto& f : kFaces) beside.push_back(c + resolution_m_ * Vec3(f[0], f[1], f[2]));
    const std::vector<karst::Cell> states = request_.map.cells(beside);
    std::vector<SurfaceCell> out;
    for (std::size_t i = 0; i < centers.size(); ++i) {
      Vec3 n;
      for (std::size_t j = 0; j < 6; ++j)
        if (states[6 * i + j] == karst::Cell::free) n = n + Vec3(kFaces[j][0], kFaces[j][1], kFaces[j][2]);
      const double length = norm(n);
      out.push_back({centers[i], length > 0 ? (1 / length) * n : Vec3()});
    }
    return out;
  }

  const karst::Request& request_;
  const OwnMemory& memory_;
  ImagingCamera camera_;
  double resolution_m_;
  // What is not imaged in a box, sorted by z, then y, then x.
  mutable Box known_box_{{1, 1, 1}, {0, 0, 0}};
  mutable std::vector<KnownCell> known_;
};

std::unique_ptr<Account> OwnMemory::update(const karst::Request& request) {
  auto account = std::make_unique<OwnAccount>(request, *this);
  const double resolution_m = request.map.resolution_m();
  for (const Vec3& c : account->seen(request.position(), request.state.orientation))
    imaged_.insert(cell_id(c, resolution_m));
  return std::make_unique<OwnAccount>(request, *this);  // without what it read before these were imaged
}

}  // namespace surface_coverage
