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

struct Corners {
  Vec3 a, b, c;
  Vec3 normal() const { return (b - a).cross(c - a).normalized(); }
};

/// A triangle as a ray needs it, in one place: its corners are scattered over the mesh's vertices, and its
/// normal takes two square roots.
struct RayTriangle {
  Vec3f a, b, c, normal;  // normal: unit, on either side

  Corners corners() const { return {a.cast<double>(), b.cast<double>(), c.cast<double>()}; }
};

static std::vector<RayTriangle> ray_triangles(const TriangleMesh& mesh) {
  std::vector<RayTriangle> out;
  out.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const auto& v = mesh.vertices;
    RayTriangle triangle{v[t[0]], v[t[1]], v[t[2]], Vec3f::Zero()};
    triangle.normal = triangle.corners().normal().cast<float>().normalized();
    out.push_back(triangle);
  }
  return out;
}

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The unit normal, on the side that a ray in this direction comes from.
Vec3f towards(const Vec3f& direction, const Vec3f& normal) {
  return normal.dot(direction) > 0 ? Vec3f(-normal) : normal;
}

/// The nearer root of |o + t d - c| = r; from inside, the root where the ray leaves the ball.
void meet(const Sphere& s, const Ray& ray, float max_range_m, Hit& hit) {
  const Vec3 o = ray.origin.cast<double>() - s.centre, d = ray.direction.cast<double>();
  const double b = o.dot(d), c = o.squaredNorm() - s.radius_m * s.radius_m, disc = b * b - c;
  if (disc < 0) return;
  const double t = c > 0 ? -b - std::sqrt(disc) : -b + std::sqrt(disc);
  const auto range = static_cast<float>(t);
  if (t < 0 || range > max_range_m || range >= hit.range_m) return;
  hit = {range, kBoulder, towards(ray.direction, (o + t * d).cast<float>().normalized())};
}

// Embree selects candidate triangles, but never computes the answer. So that the rounding of one processor
// does not omit a triangle that another one tests, the boxes, ranges and radii given to Embree are enlarged
// by far more than the error of its single-precision boxes and slabs.

/// Bound in metres of the error of Embree's arithmetic, at coordinates and distances up to `extent_m`.
float slack_m(float extent_m) { return 1e-3f + 4e-6f * extent_m; }

void box_of_triangle(const RTCBoundsFunctionArguments* args) {
  const RayTriangle& t = static_cast<const RayTriangle*>(args->geometryUserPtr)[args->primID];
  const Vec3f low = t.a.cwiseMin(t.b).cwiseMin(t.c), high = t.a.cwiseMax(t.b).cwiseMax(t.c);
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

/// One float per ray of a packet: a vector of the compiler, because Eigen's are no wider than the whole
/// program's instruction set.
using Lanes = float __attribute__((vector_size(kPacket * sizeof(float))));
using LaneMask = std::int32_t __attribute__((vector_size(kPacket * sizeof(float))));

/// Marks the rays of a whole packet that may meet the triangle: all that do, and few others. The volumes of
/// ray_triangle_range() in single precision: their error is below 12 epsilon |o a| |o b|, so signs that
/// differ by more than `bound` differ in double precision as well.
[[gnu::always_inline]] inline void mark_candidates(const float* rays, const RayTriangle& t,
                                                   std::int32_t* may) {
  const Lanes* const member = reinterpret_cast<const Lanes*>(rays);  // aligned: RTCRayHit8
  const Lanes ox = member[0], oy = member[1], oz = member[2];
  const Lanes dx = member[4], dy = member[5], dz = member[6];
  const Lanes ax = t.a.x() - ox, ay = t.a.y() - oy, az = t.a.z() - oz;
  const Lanes bx = t.b.x() - ox, by = t.b.y() - oy, bz = t.b.z() - oz;
  const Lanes cx = t.c.x() - ox, cy = t.c.y() - oy, cz = t.c.z() - oz;
  const Lanes u = dx * (cy * bz - cz * by) + dy * (cz * bx - cx * bz) + dz * (cx * by - cy * bx);
  const Lanes v = dx * (ay * cz - az * cy) + dy * (az * cx - ax * cz) + dz * (ax * cy - ay * cx);
  const Lanes w = dx * (by * az - bz * ay) + dy * (bz * ax - bx * az) + dz * (bx * ay - by * ax);
  const Lanes a2 = ax * ax + ay * ay + az * az, b2 = bx * bx + by * by + bz * bz,
              c2 = cx * cx + cy * cy + cz * cz;
  const Lanes ab2 = a2 > b2 ? a2 : b2, bound = 2e-6f * (ab2 > c2 ? ab2 : c2);
  const LaneMask negative = (u < -bound) | (v < -bound) | (w < -bound),
                 positive = (u > bound) | (v > bound) | (w > bound), neither = ~(negative & positive);
  __builtin_memcpy(may, &neither, sizeof neither);
}

// The same arithmetic with eight lanes to an instruction where the processor has AVX2: no fused multiply-add,
// so the marks are the same.
[[gnu::target("avx2")]] void mark_candidates_by_avx2(const float* rays, const RayTriangle& t,
                                                     std::int32_t* may) {
  mark_candidates(rays, t, may);
}
void mark_candidates_by_sse(const float* rays, const RayTriangle& t, std::int32_t* may) {
  mark_candidates(rays, t, may);
}

void meet_triangle(const RTCIntersectFunctionNArguments* args) {
  static const auto mark = __builtin_cpu_supports("avx2") ? mark_candidates_by_avx2 : mark_candidates_by_sse;
  auto& search = *reinterpret_cast<PacketSearch*>(args->context);
  const RayTriangle& triangle = static_cast<const RayTriangle*>(args->geometryUserPtr)[args->primID];
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  std::array<std::int32_t, kPacket> may;
  if (args->N == kPacket)
    mark(reinterpret_cast<const float*>(rays), triangle, may.data());
  else
    may.fill(-1);
  const Corners t = triangle.corners();
  for (unsigned k = 0; k < args->N; ++k) {
    if (!(args->valid[k] & may[k])) continue;
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
    unsigned& met = RTCHitN_primID(hits, args->N, k);
    if (*range > best || (*range == best && args->primID > met)) continue;
    best = *range;
    met = args->primID;
    RTCHitN_geomID(hits, args->N, k) = args->geomID;
    const auto reach = static_cast<float>(best);
    RTCRayN_tfar(rays, args->N, k) = std::min(RTCRayN_tfar(rays, args->N, k), reach + slack_m(reach));
  }
}

struct NearestSearch {
  const RayTriangle* triangles;
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
  const Corners t = search.triangles[args->primID].corners();
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

/// Also owns the triangles, which Embree reads as long as the scene lives.
struct RayScene::Handles {
  explicit Handles(const TriangleMesh& mesh) : triangles(ray_triangles(mesh)) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(triangles.size()));
    rtcSetGeometryUserData(g, triangles.data());
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

  std::vector<RayTriangle> triangles;
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
};

RayScene::RayScene(TriangleMesh mesh)
    : mesh_(std::make_shared<const TriangleMesh>(std::move(mesh))),
      handles_(std::make_shared<const Handles>(*mesh_)) {}

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
                : Hit{static_cast<float>(search.range_m[k]), p.hit.primID[k],
                      towards(ray.direction, handles_->triangles[p.hit.primID[k]].normal)};
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
  NearestSearch search{handles_->triangles.data(), p, {within_m, p, false}, 0};
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
