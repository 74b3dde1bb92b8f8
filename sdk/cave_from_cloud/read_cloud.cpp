#include "sdk/cave_from_cloud/read_cloud.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/mesh_offset.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/cave_from_cloud/las_file.h"

namespace karst::from_cloud {
namespace {

using core::InputError;
using core::Vec3;
using core::Vec3f;
using replay::Role;

bool is_coordinate(Role r) { return r == Role::x || r == Role::y || r == Role::z; }
bool is_normal(Role r) { return r == Role::normal_x || r == Role::normal_y || r == Role::normal_z; }

class CloudBuilder final : public replay::PointSink {
 public:
  CloudBuilder(const cave::MeshFrame& frame, bool with_normals)
      : frame_(frame), with_normals_(with_normals) {}

  void begin(std::span<const replay::Field> fields) override {
    int normals = 0;
    for (const replay::Field& f : fields) {
      if (is_normal(f.role)) ++normals;
      if (is_coordinate(f.role) && f.type == replay::ValueType::float32) is_single_ = true;
    }
    with_normals_ = with_normals_ && normals == 3;
  }

  void set(Role role, double value) override {
    if (is_coordinate(role)) position_[static_cast<int>(role) - static_cast<int>(Role::x)] = value;
    if (is_normal(role)) normal_[static_cast<int>(role) - static_cast<int>(Role::normal_x)] = value;
  }

  void end_point() override {
    ++file_.points;
    const Vec3 p = cave::to_metres(frame_, position_ - frame_.offset);
    if (!p.allFinite()) {
      ++file_.not_finite;
      return;
    }
    box_.extend(p);
    farthest_ = std::max(farthest_, position_.cwiseAbs().maxCoeff());
    if (p.cwiseAbs().maxCoeff() > cave::kFarthestVertex_m) return;  // the file will be refused
    PointCloud& cloud = file_.cloud;
    if (cloud.points.empty()) cloud.origin = p.array().round();
    cloud.points.push_back((p - cloud.origin).cast<float>());
    if (with_normals_) cloud.normals.push_back(unit_normal());
  }

  CloudFile take(const std::string& path) {
    if (file_.points == 0) throw InputError(path, "", "holds no point");
    if (box_.isEmpty())
      throw InputError(path, "",
                       "holds no point with finite coordinates, of " + std::to_string(file_.points));
    if (const std::string problem = cave::reach_problem(box_, frame_); !problem.empty())
      throw InputError(path, "", problem);
    if (is_single_ && farthest_ * frame_.metres_per_unit > cave::kFarthestVertex_m)
      throw InputError(
          path, "",
          core::format_text("holds its coordinates in single precision: at %.0f they are rounded "
                            "to %.2g, and no offset brings that back; export it near its "
                            "origin, in double precision, or as LAS",
                            farthest_, cave::float_spacing(farthest_)));
    drop_missing_normals();
    return std::move(file_);
  }

 private:
  /// Zero if there is none.
  Vec3f unit_normal() const {
    const double length = normal_.norm();
    if (!(length > 1e-6) || !std::isfinite(length)) return Vec3f::Zero();
    const Vec3 n = cave::to_metres(frame_, normal_ / length);
    return n.normalized().cast<float>();
  }

  void drop_missing_normals() {
    PointCloud& cloud = file_.cloud;
    const auto missing = static_cast<std::size_t>(
        std::count_if(cloud.normals.begin(), cloud.normals.end(), [](const Vec3f& n) { return n.isZero(); }));
    if (2 * missing > cloud.normals.size()) {
      cloud.normals.clear();
      return;
    }
    if (missing == 0) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      if (cloud.normals[i].isZero()) continue;
      cloud.points[kept] = cloud.points[i];
      cloud.normals[kept++] = cloud.normals[i];
    }
    cloud.points.resize(kept);
    cloud.normals.resize(kept);
    file_.without_normal = missing;
  }

  const cave::MeshFrame& frame_;
  bool with_normals_, is_single_ = false;
  Vec3 position_ = Vec3::Zero(), normal_ = Vec3::Zero();
  Eigen::AlignedBox3d box_;
  double farthest_ = 0;  // coordinate of the file
  CloudFile file_;
};

}  // namespace

CloudFile read_cloud(const std::string& path, const cave::MeshFrame& frame, bool with_normals) {
  CloudBuilder builder(frame, with_normals);
  std::size_t withheld = 0;
  const std::string ending = cave::lower_extension(path);
  if (ending == ".ply")
    replay::read_ply(path, {}, builder);
  else if (ending == ".pcd")
    replay::read_pcd(path, {}, builder);
  else if (ending == ".las")
    withheld = read_las(path, builder);
  else if (ending == ".laz")
    throw InputError(path, "", "is compressed: unpack it with `laszip -i FILE.laz -o FILE.las`");
  else
    throw InputError(path, "", "a point cloud must be a .ply, .pcd or .las file");
  CloudFile file = builder.take(path);
  file.withheld = withheld;
  file.points += withheld;
  return file;
}

}  // namespace karst::from_cloud
