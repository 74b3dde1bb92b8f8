#include "plugins/simulator/cave/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "plugins/simulator/cave/closest_point.h"
#include "plugins/simulator/cave/ray_triangle.h"

namespace karst::cave {

using core::Vec3;
using core::Vec3f;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Hit to_hit(float range, std::uint32_t triangle, Vec3f normal, const Vec3f& direction) {
  normal.normalize();
  if (normal.dot(direction) > 0) normal = -normal;
  return {range, triangle, normal};
}

/// The nearer root of |o + t d - c| = r; from inside, the root where the ray leaves the ball.
void meet(const Sphere& s, const Ray& ray, float max_range_m, Hit& hit) {
  const Vec3 o = ray.origin.cast<double>() - s.centre, d = ray.direction.cast<double>();
  const double b = o.dot(d), c = o.squaredNorm() - s.radius_m * s.radius_m, disc = b * b - c;
  if (disc < 0) return;
  const double t = c > 0 ? -b - std::sqrt(disc) : -b + std::sqrt(disc);
  const auto range = static_cast<float>(t);
  if (t < 0 || range > max_range_m || range >= hit.range_m) return;
  hit = to_hit(range, kBoulder, (o + t * d).cast<float>(), ray.direction);
}

struct Corners {
  Vec3 a, b, c;
  Vec3 normal() const { return (b - a).cross(c - a).normalized(); }
};

Corners corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const auto& v = mesh.vertices;
  return {v[t[0]].cast<double>(), v[t[1]].cast<double>(), v[t[2]].cast<double>()};
}

// Embree selects candidate triangles, but never computes the answer. So that the rounding of one processor
// does not omit a triangle that another one tests, the boxes, ranges and radii given to Embree are enlarged
// by far more than the error of its single-precision boxes and slabs.

/// Bound in metres of the error of Embree's arithmetic, at coordinates and distances up to `extent_m`.
float slack_m(float extent_m) { return 1e-3f + 4e-6f * extent_m; }

void box_of_triangle(const RTCBoundsFunctionArguments* args) {
  const auto& mesh = *static_cast<const TriangleMesh*>(args->geometryUserPtr);
  const auto& t = mesh.triangles[args->primID];
  const Vec3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const float slack = slack_m(low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff());
  RTCBounds& box = *args->bounds_o;
  box.lower_x = low.x() - slack;
  box.lower_y = low.y() - slack;
  box.lower_z = low.z() - slack;
  box.upper_x = high.x() + slack;
  box.upper_y = high.y() + slack;
  box.upper_z = high.z() + slack;
}

constexpr unsigned kPacket = 8;

/// The hits of a packet of rays so far; Embree passes its first member to meet_triangle().
struct PacketSearch {
  RTCIntersectContext context;
  std::array<double, kPacket> range_m;
  std::vector<double>* crossings;  // if not null: collects all ranges of a single ray instead
};

using Lanes = Eigen::Array<float, kPacket, 1>;

struct LaneVectors {
  Lanes x, y, z;

  LaneVectors cross(const LaneVectors& o) const {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
  Lanes dot(const LaneVectors& o) const { return x * o.x + y * o.y + z * o.z; }
};

/// Which rays of a whole packet may meet the triangle: all that do, and few others. The volumes of
/// ray_triangle_range() in single precision: their error is below 12 epsilon |o a| |o b|, so signs that
/// differ by more than `bound` differ in double precision as well.
std::array<bool, kPacket> may_meet(const RTCRayN* rays, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const auto lanes = [rays](int member) {
    return Eigen::Map<const Lanes>(reinterpret_cast<const float*>(rays) + member * static_cast<int>(kPacket));
  };
  const LaneVectors o{lanes(0), lanes(1), lanes(2)}, d{lanes(4), lanes(5), lanes(6)};
  const auto from = [&o](const Vec3f& p) -> LaneVectors { return {p.x() - o.x, p.y() - o.y, p.z() - o.z}; };
  const LaneVectors oa = from(a), ob = from(b), oc = from(c);
  const Lanes u = d.dot(oc.cross(ob)), v = d.dot(oa.cross(oc)), w = d.dot(ob.cross(oa));
  const Lanes bound = 2e-6f * oa.dot(oa).max(ob.dot(ob)).max(oc.dot(oc));
  const Eigen::Array<bool, kPacket, 1> mixed = u.min(v).min(w) < -bound && u.max(v).max(w) > bound;
  std::array<bool, kPacket> may{};
  for (unsigned k = 0; k < kPacket; ++k) may[k] = !mixed[k];
  return may;
}

void meet_triangle(const RTCIntersectFunctionNArguments* args) {
  auto& search = *reinterpret_cast<PacketSearch*>(args->context);
  const TriangleMesh& mesh = *static_cast<const TriangleMesh*>(args->geometryUserPtr);
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  std::array<bool, kPacket> may;
  may.fill(true);
  if (args->N == kPacket) {
    const auto& t = mesh.triangles[args->primID];
    may = may_meet(rays, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  for (unsigned k = 0; k < args->N; ++k) {
    if (!args->valid[k] || !may[k]) continue;
    const Corners t = corners(mesh, args->primID);
    const Vec3 o(RTCRayN_org_x(rays, args->N, k), RTCRayN_org_y(rays, args->N, k),
                 RTCRayN_org_z(rays, args->N, k));
    const Vec3 d(RTCRayN_dir_x(rays, args->N, k), RTCRayN_dir_y(rays, args->N, k),
                 RTCRayN_dir_z(rays, args->N, k));
    const std::optional<double> range = ray_triangle_range(o, d, t.a, t.b, t.c);
    if (!range) continue;
    if (search.crossings) {
      search.crossings->push_back(*range);
      continue;
    }
    double& best = search.range_m[RTCRayN_id(rays, args->N, k)];
    unsigned& triangle = RTCHitN_primID(hits, args->N, k);
    if (*range > best || (*range == best && args->primID > triangle)) continue;
    best = *range;
    triangle = args->primID;
    RTCHitN_geomID(hits, args->N, k) = args->geomID;
    const auto reach = static_cast<float>(best);
    RTCRayN_tfar(rays, args->N, k) = std::min(RTCRayN_tfar(rays, args->N, k), reach + slack_m(reach));
  }
}

struct NearestSearch {
  const TriangleMesh* mesh;
  Vec3 p;
  Nearest best;
  std::uint32_t triangle;
};

/// The query position is rounded to floats, so the radius is enlarged by the distance it may be off `p`.
float query_radius(const Vec3& p, double distance_m) {
  const auto distance = static_cast<float>(distance_m);
  return distance + slack_m(distance + static_cast<float>(p.cwiseAbs().maxCoeff()));
}

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  auto& search = *static_cast<NearestSearch*>(args->userPtr);
  const Corners t = corners(*search.mesh, args->primID);
  const Vec3 q = closest_on_triangle(search.p, t.a, t.b, t.c);
  const double d = (q - search.p).norm();
  if (d > search.best.distance_m) return false;
  if (d == search.best.distance_m && (!search.best.found || args->primID > search.triangle)) return false;
  search.best = {d, q, true};
  search.triangle = args->primID;
  args->query->radius = std::min(args->query->radius, query_radius(search.p, d));
  return true;
}

}  // namespace

/// Also owns the mesh: Embree reads its triangles as long as the scene lives.
struct RayScene::Handles {
  explicit Handles(std::shared_ptr<const TriangleMesh> m) : mesh(std::move(m)) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(mesh->triangles.size()));
    rtcSetGeometryUserData(g, const_cast<TriangleMesh*>(mesh.get()));
    rtcSetGeometryBoundsFunction(
        g, [](const RTCBoundsFunctionArguments* args) { box_of_triangle(args); }, nullptr);
    rtcSetGeometryIntersectFunction(g, meet_triangle);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
  }
  ~Handles() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  std::shared_ptr<const TriangleMesh> mesh;
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
};

RayScene::RayScene(TriangleMesh mesh)
    : mesh_(std::make_shared<const TriangleMesh>(std::move(mesh))),
      handles_(std::make_shared<const Handles>(mesh_)) {}

RayScene RayScene::with_boulders(std::vector<Sphere> boulders) const {
  RayScene scene = *this;
  scene.boulders_ = std::move(boulders);
  return scene;
}

void RayScene::cast(std::span<const Ray> rays, float max_range_m, std::span<Hit> out) const {
  PacketSearch search;
  rtcInitIntersectContext(&search.context);
  search.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  search.crossings = nullptr;
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t n = std::min<std::size_t>(kPacket, rays.size() - first);
    alignas(32) int valid[kPacket];
    alignas(32) RTCRayHit8 p;
    for (unsigned k = 0; k < kPacket; ++k) {
      const Ray& ray = rays[first + std::min<std::size_t>(k, n - 1)];
      valid[k] = k < n ? -1 : 0;
      p.ray.org_x[k] = ray.origin.x();
      p.ray.org_y[k] = ray.origin.y();
      p.ray.org_z[k] = ray.origin.z();
      p.ray.dir_x[k] = ray.direction.x();
      p.ray.dir_y[k] = ray.direction.y();
      p.ray.dir_z[k] = ray.direction.z();
      p.ray.tnear[k] = 0;
      p.ray.tfar[k] = max_range_m + slack_m(max_range_m);
      p.ray.time[k] = 0;
      p.ray.mask[k] = ~0u;
      p.ray.id[k] = k;
      p.ray.flags[k] = 0;
      p.hit.primID[k] = p.hit.geomID[k] = p.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    search.range_m.fill(static_cast<double>(max_range_m));
    rtcIntersect8(valid, handles_->scene, &search.context, &p);
    for (unsigned k = 0; k < n; ++k) {
      const Ray& ray = rays[first + k];
      Hit& hit = out[first + k];
      hit = p.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                ? Hit{}
                : to_hit(static_cast<float>(search.range_m[k]), p.hit.primID[k],
                         corners(*mesh_, p.hit.primID[k]).normal().cast<float>(), ray.direction);
      for (const Sphere& s : boulders_) meet(s, ray, max_range_m, hit);
    }
  }
}

Hit RayScene::cast(const Ray& ray, float max_range_m) const {
  Hit hit;
  cast({&ray, 1}, max_range_m, {&hit, 1});
  return hit;
}

double RayScene::ray_cast(const Vec3& from, const Vec3& direction, double max_range_m) const {
  const Ray ray{from.cast<float>(), direction.normalized().cast<float>()};
  return static_cast<double>(cast(ray, static_cast<float>(max_range_m)).range_m);
}

std::vector<double> RayScene::surfaces(const Ray& ray) const {
  constexpr double kOneSurface_m = 1e-4;
  std::vector<double> ranges;
  PacketSearch search;
  rtcInitIntersectContext(&search.context);
  search.crossings = &ranges;
  RTCRayHit r{};
  r.ray.org_x = ray.origin.x();
  r.ray.org_y = ray.origin.y();
  r.ray.org_z = ray.origin.z();
  r.ray.dir_x = ray.direction.x();
  r.ray.dir_y = ray.direction.y();
  r.ray.dir_z = ray.direction.z();
  r.ray.tfar = kInfinity;
  r.ray.mask = ~0u;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(handles_->scene, &search.context, &r);
  std::sort(ranges.begin(), ranges.end());
  std::size_t n = 0;  // of those that count, which are moved to the front
  for (const double range : ranges)
    if (n == 0 || range > ranges[n - 1] + kOneSurface_m) ranges[n++] = range;
  ranges.resize(n);
  return ranges;
}

Nearest RayScene::nearest(const Vec3& p, double within_m) const {
  NearestSearch search{mesh_.get(), p, {within_m, p, false}, 0};
  RTCPointQuery query;
  query.x = static_cast<float>(p.x());
  query.y = static_cast<float>(p.y());
  query.z = static_cast<float>(p.z());
  query.time = 0;
  query.radius = query_radius(p, within_m);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(handles_->scene, &query, &context, visit_triangle, &search);
  for (const Sphere& s : boulders_) {
    const Vec3 from_centre = p - s.centre;
    const double d = std::abs(from_centre.norm() - s.radius_m);
    if (d >= search.best.distance_m) continue;
    const Vec3 out = from_centre.norm() > 0 ? from_centre.normalized() : Vec3::UnitZ();
    search.best = {d, s.centre + s.radius_m * out, true};
  }
  return search.best;
}

}  // namespace karst::cave
