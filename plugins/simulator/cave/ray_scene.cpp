#include "plugins/simulator/cave/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "plugins/simulator/cave/closest_point.h"

namespace karst::cave {

using core::Vec3;
using core::Vec3f;

struct RayScene::Handles {
  RTCDevice device = rtcNewDevice(device_config());
  RTCScene scene = rtcNewScene(device);
  ~Handles() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

RTCRayHit to_embree(const Ray& ray, float near, float far) {
  RTCRayHit r{};
  r.ray.org_x = ray.origin.x(), r.ray.org_y = ray.origin.y(), r.ray.org_z = ray.origin.z();
  r.ray.dir_x = ray.direction.x(), r.ray.dir_y = ray.direction.y(), r.ray.dir_z = ray.direction.z();
  r.ray.tnear = near, r.ray.tfar = far;
  r.ray.mask = ~0u;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return r;
}

Hit to_hit(float range, std::uint32_t triangle, Vec3f normal, const Vec3f& direction) {
  normal.normalize();
  if (normal.dot(direction) > 0) normal = -normal;
  return {range, triangle, normal};
}

/// The nearer root of |o + t d - c| = r; from inside, the surface is met where the ray leaves.
void meet(const Sphere& s, const Ray& ray, float max_range_m, Hit& hit) {
  const Vec3 o = ray.origin.cast<double>() - s.centre, d = ray.direction.cast<double>();
  const double b = o.dot(d), c = o.squaredNorm() - s.radius_m * s.radius_m, disc = b * b - c;
  if (disc < 0) return;
  const double t = c > 0 ? -b - std::sqrt(disc) : -b + std::sqrt(disc);
  const auto range = static_cast<float>(t);
  if (t < 0 || range > max_range_m || range >= hit.range_m) return;
  hit = to_hit(range, kBoulder, (o + t * d).cast<float>(), ray.direction);
}

struct NearestSearch {
  const TriangleMesh* mesh;
  Vec3 p;
  Nearest best;
};

bool visit_triangle(RTCPointQueryFunctionArguments* args) {
  auto& search = *static_cast<NearestSearch*>(args->userPtr);
  const auto& t = search.mesh->triangles[args->primID];
  const auto& v = search.mesh->vertices;
  const Vec3 q =
      closest_on_triangle(search.p, v[t[0]].cast<double>(), v[t[1]].cast<double>(), v[t[2]].cast<double>());
  const double d = (q - search.p).norm();
  if (d >= search.best.distance_m) return false;
  search.best = {d, q, true};
  args->query->radius = std::nextafter(static_cast<float>(d), kInfinity);
  return true;
}

}  // namespace

const char* RayScene::device_config() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? "threads=1,isa=avx2"
                                                                         : "threads=1,isa=sse4.2";
}

RayScene::RayScene(TriangleMesh mesh)
    : mesh_(std::make_shared<const TriangleMesh>(std::move(mesh))),
      handles_(std::make_shared<const Handles>()) {
  RTCGeometry g = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                           mesh_->vertices.size());
  std::memcpy(vertices, mesh_->vertices.data(), mesh_->vertices.size() * sizeof(Vec3f));
  void* indices =
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh_->triangles.size());
  std::memcpy(indices, mesh_->triangles.data(), mesh_->triangles.size() * 12);
  rtcCommitGeometry(g);
  rtcAttachGeometry(handles_->scene, g);
  rtcReleaseGeometry(g);
  rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
  rtcCommitScene(handles_->scene);
}

RayScene RayScene::with_boulders(std::vector<Sphere> boulders) const {
  RayScene scene = *this;
  scene.boulders_ = std::move(boulders);
  return scene;
}

void RayScene::cast(std::span<const Ray> rays, float max_range_m, std::span<Hit> out) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t first = 0; first < rays.size(); first += 8) {
    const std::size_t n = std::min<std::size_t>(8, rays.size() - first);
    alignas(32) int valid[8];
    alignas(32) RTCRayHit8 p;
    for (std::size_t k = 0; k < 8; ++k) {
      const Ray& ray = rays[first + std::min(k, n - 1)];
      valid[k] = k < n ? -1 : 0;
      p.ray.org_x[k] = ray.origin.x(), p.ray.org_y[k] = ray.origin.y(), p.ray.org_z[k] = ray.origin.z();
      p.ray.dir_x[k] = ray.direction.x(), p.ray.dir_y[k] = ray.direction.y(),
      p.ray.dir_z[k] = ray.direction.z();
      p.ray.tnear[k] = 0, p.ray.tfar[k] = max_range_m, p.ray.time[k] = 0;
      p.ray.mask[k] = ~0u, p.ray.id[k] = 0, p.ray.flags[k] = 0;
      p.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      p.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, handles_->scene, &context, &p);
    for (std::size_t k = 0; k < n; ++k) {
      out[first + k] = p.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                           ? Hit{}
                           : to_hit(p.ray.tfar[k], p.hit.primID[k],
                                    {p.hit.Ng_x[k], p.hit.Ng_y[k], p.hit.Ng_z[k]}, rays[first + k].direction);
      for (const Sphere& s : boulders_) meet(s, rays[first + k], max_range_m, out[first + k]);
    }
  }
}

Hit RayScene::cast(const Ray& ray, float max_range_m) const {
  // A packet of one: rtcIntersect1 uses another kernel, whose ranges differ in the last bits.
  Hit hit;
  cast({&ray, 1}, max_range_m, {&hit, 1});
  return hit;
}

double RayScene::ray_cast(const Vec3& from, const Vec3& direction, double max_range_m) const {
  const Ray ray{from.cast<float>(), direction.normalized().cast<float>()};
  return static_cast<double>(cast(ray, static_cast<float>(max_range_m)).range_m);
}

int RayScene::crossings(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  float near = 0;
  for (int n = 0;; ++n) {
    RTCRayHit r = to_embree(ray, near, kInfinity);
    rtcIntersect1(handles_->scene, &context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return n;
    near = std::max(r.ray.tfar + 1e-4f, std::nextafter(r.ray.tfar, kInfinity));
  }
}

Nearest RayScene::nearest(const Vec3& p, double within_m) const {
  NearestSearch search{mesh_.get(), p, {within_m, p, false}};
  RTCPointQuery query;
  query.x = static_cast<float>(p.x()), query.y = static_cast<float>(p.y()),
  query.z = static_cast<float>(p.z());
  query.time = 0;
  query.radius = std::nextafter(static_cast<float>(within_m), kInfinity);
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
