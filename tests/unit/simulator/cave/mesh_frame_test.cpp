#include "plugins/simulator/cave/mesh_frame.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>

#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/mesh_offset.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using cave::load_mesh;
using cave::MeshFrame;
using cave::TriangleMesh;
using core::MeshUnit;
using core::UpAxis;

/// The mesh as text, with each vertex as `moved` has it, to fractions of a micrometre.
std::string obj_text(const TriangleMesh& mesh, const std::function<Vec3(const Vec3&)>& moved) {
  std::string text;
  for (const Vec3f& v : mesh.vertices) {
    const Vec3 p = moved(v.cast<double>());
    text += core::format_text("v %.7f %.7f %.7f\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles)
    text += core::format_text("f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string text_stl(const TriangleMesh& mesh, const Vec3& moved) {
  std::string text = "solid cave\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const std::uint32_t i : t) {
      const Vec3 p = mesh.vertices[i].cast<double>() + moved;
      text += core::format_text("  vertex %.7f %.7f %.7f\n", p.x(), p.y(), p.z());
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid cave\n";
}

template <class T>
void put_number(std::string& bytes, T value, bool big_endian) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// PLY whose vertices have a number before x, y, z and one behind.
template <class T>
std::string binary_ply(const TriangleMesh& mesh, const Vec3& moved, const std::string& type,
                       bool big_endian) {
  std::string bytes =
      std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\nelement vertex " +
      std::to_string(mesh.vertices.size()) + "\nproperty uchar red\nproperty " + type + " x\nproperty " +
      type + " y\nproperty " + type + " z\nproperty short quality\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3f& v : mesh.vertices) {
    const Vec3 p = v.cast<double>() + moved;
    bytes += '\7';
    for (int axis = 0; axis < 3; ++axis) put_number(bytes, static_cast<T>(p[axis]), big_endian);
    put_number(bytes, std::int16_t{-3}, big_endian);
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    for (const std::uint32_t i : t) put_number(bytes, i, big_endian);
  }
  return bytes;
}

std::string text_ply(const TriangleMesh& mesh, const Vec3& moved) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
      "\nproperty int red\nproperty float x\nproperty float y\nproperty float z\nproperty float quality\n"
      "element face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3f& v : mesh.vertices) {
    const Vec3 p = v.cast<double>() + moved;
    text += core::format_text("7 %.7f %.7f %.7f 1\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) text += core::format_text("3 %u %u %u\n", t[0], t[1], t[2]);
  return text;
}

/// The greatest distance between corners of the same triangles.
double difference(const TriangleMesh& a, const TriangleMesh& b) {
  if (a.triangles.size() != b.triangles.size()) return 1e9;
  double greatest_m = 0;
  for (std::size_t i = 0; i < a.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      greatest_m = std::max(
          greatest_m,
          static_cast<double>((a.vertices[a.triangles[i][k]] - b.vertices[b.triangles[i][k]]).norm()));
  return greatest_m;
}

class MeshFrames : public testing::Test {
 protected:
  std::string written(const std::string& name, const std::string& bytes) const {
    write_bytes(folder_ + "/" + name, bytes);
    return folder_ + "/" + name;
  }
  static MeshFrame frame(const core::MeshKeys& keys) { return cave::mesh_frame("keys", "a.obj", keys); }
  static MeshFrame offset(const Vec3& o) {
    MeshFrame f;
    f.offset = o;
    return f;
  }

  std::string folder_ = scratch_folder();
  TriangleMesh tunnel_ = tunnel_mesh(10, 2, 1);
};

const Vec3 kUtm(423456, 5212345, 1203);  // somewhere in the Alps

TEST_F(MeshFrames, AUnitIsNamedWhereItHasAName) {
  const auto text = [](double scale, MeshUnit unit) {
    return cave::unit_text(frame({scale, unit, UpAxis::z, ""}));
  };
  EXPECT_EQ(text(1, MeshUnit::m), "m");
  EXPECT_EQ(text(1, MeshUnit::ft), "ft");
  EXPECT_EQ(text(1, MeshUnit::in), "in");
  EXPECT_EQ(text(0.001, MeshUnit::m), "mm") << "whichever key says so";
  EXPECT_EQ(text(0.5, MeshUnit::m), "0.5 m");
}

TEST_F(MeshFrames, ACubeInAnyUnitIsTheSameCube) {
  const TriangleMesh cube = box_mesh({0, 0, 0}, {4, 4, 4});
  for (const auto& [unit, in_a_metre] : {std::pair{MeshUnit::m, 1.0},
                                         {MeshUnit::cm, 100.0},
                                         {MeshUnit::mm, 1000.0},
                                         {MeshUnit::ft, 1 / 0.3048},
                                         {MeshUnit::in, 1 / 0.0254}}) {
    const double factor = in_a_metre;
    const std::string file = written("cube.obj", obj_text(cube, [&](const Vec3& p) { return factor * p; }));
    const Eigen::AlignedBox3d box = box_of(load_mesh(file, frame({1, unit, UpAxis::z, ""})));
    EXPECT_LT(box.min().norm(), 1e-6) << core::name_of(unit);
    EXPECT_LT((box.max() - Vec3(4, 4, 4)).norm(), 1e-5) << core::name_of(unit);
    const Eigen::AlignedBox3d twice = box_of(load_mesh(file, frame({2, unit, UpAxis::z, ""})));
    EXPECT_LT((twice.max() - Vec3(8, 8, 8)).norm(), 1e-5) << "the scale counts beside the unit";
  }
}

TEST_F(MeshFrames, WithYUpTheMeshIsTurnedAndNotMirrored) {
  // East is x, up is y, so south is z.
  const std::string turned =
      written("y.obj", obj_text(tunnel_, [](const Vec3& p) { return Vec3(p.x(), p.z(), -p.y()); }));
  const std::string plain = written("z.obj", obj_text(tunnel_, [](const Vec3& p) { return p; }));
  const TriangleMesh a = load_mesh(turned, frame({1, MeshUnit::m, UpAxis::y, ""})), b = load_mesh(plain);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.vertices, b.vertices);
}

TEST_F(MeshFrames, OfUtmCoordinatesNothingIsLost) {
  const auto moved = [](const Vec3& p) -> Vec3 { return p + kUtm; };
  for (const auto& [name, bytes] : {std::pair{"utm.obj", obj_text(tunnel_, moved)},
                                    {"utm.stl", text_stl(tunnel_, kUtm)},
                                    {"text.ply", text_ply(tunnel_, kUtm)},
                                    {"little.ply", binary_ply<double>(tunnel_, kUtm, "double", false)},
                                    {"big.ply", binary_ply<double>(tunnel_, kUtm, "float64", true)}}) {
    const std::string file = written(name, bytes);
    EXPECT_TRUE(cave::holds_double_precision(file)) << name;
    EXPECT_LT(difference(load_mesh(file, offset(kUtm)), tunnel_), 2e-6) << name;
  }
}

TEST_F(MeshFrames, AnOffsetIsSubtractedBeforeTheMeshIsTurnedAndScaled) {
  const Vec3 origin(1000, 2000, 3000);
  const std::string file = written("all.obj", obj_text(tunnel_, [&](const Vec3& p) -> Vec3 {
                                     return origin + 1000.0 * Vec3(p.x(), p.z(), -p.y());
                                   }));
  const TriangleMesh read = load_mesh(file, frame({1, MeshUnit::mm, UpAxis::y, "1000 2000 3000"}));
  EXPECT_LT(difference(read, tunnel_), 2e-6);
}

TEST_F(MeshFrames, FloatsNearTheOriginMayHaveAnOffset) {
  const Vec3 near(50, -20, 7);
  TriangleMesh there = tunnel_;
  for (Vec3f& v : there.vertices) v += near.cast<float>();
  for (const char* name : {"near.stl", "near.ply"}) {
    cave::write_mesh(folder_ + "/" + name, there);
    EXPECT_FALSE(cave::holds_double_precision(folder_ + "/" + name)) << name;
    EXPECT_LT(difference(load_mesh(folder_ + "/" + name, offset(near)), tunnel_), 2e-5) << name;
  }
  std::string bytes = read_bytes(folder_ + "/near.stl");
  bytes.replace(0, 5, "solid");  // as some programs begin a binary file
  const std::string solid = written("solid.stl", bytes);
  EXPECT_FALSE(cave::holds_double_precision(solid));
  EXPECT_LT(difference(load_mesh(solid, offset(near)), tunnel_), 2e-5);
  const std::string big = written("big.ply", binary_ply<float>(there, Vec3::Zero(), "float", true));
  EXPECT_LT(difference(load_mesh(big, offset(near)), tunnel_), 2e-5);
}

TEST_F(MeshFrames, FloatsThatWereRoundedAreRefusedWithOrWithoutAnOffset) {
  TriangleMesh far = tunnel_;
  for (Vec3f& v : far.vertices) v += kUtm.cast<float>();
  for (const char* name : {"far.stl", "far.ply"}) {
    cave::write_mesh(folder_ + "/" + name, far);
    for (const MeshFrame& f : {MeshFrame{}, offset(kUtm)}) {
      const std::string e = error_of([&] { load_mesh(folder_ + "/" + name, f); });
      EXPECT_NE(e.find("single precision"), std::string::npos) << e;
      EXPECT_NE(e.find(cave::has_offset(f) ? "they are rounded to" : "rounded to 0.5"), std::string::npos)
          << e;
      EXPECT_NE(e.find(name), std::string::npos) << e;
    }
  }
}

TEST_F(MeshFrames, WithoutTheOffsetTheErrorNamesIt) {
  const std::string file =
      written("utm.obj", obj_text(tunnel_, [](const Vec3& p) -> Vec3 { return p + kUtm; }));
  const std::string e = error_of([&] { load_mesh(file); });
  EXPECT_NE(e.find("within 100 km"), std::string::npos) << e;
  EXPECT_NE(e.find("likely in UTM coordinates"), std::string::npos) << e;
  double x = 0, y = 0, z = 0;
  const std::size_t at = e.find("offset \"");
  ASSERT_NE(at, std::string::npos) << e;
  ASSERT_EQ(std::sscanf(e.c_str() + at + 8, "%lf %lf %lf", &x, &y, &z), 3) << e;
  const Eigen::AlignedBox3d box = box_of(load_mesh(file, offset({x, y, z})));
  EXPECT_LT(box.min().cwiseAbs().maxCoeff(), 12) << "a tunnel of 10 m is at the origin now";
  EXPECT_LT(box.max().cwiseAbs().maxCoeff(), 12);
  EXPECT_EQ(e.find("single precision"), std::string::npos) << e;
}

TEST_F(MeshFrames, VerticesThatCannotBeMovedAreRefusedWithTheirLine) {
  const std::string rest = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const auto& [line, reason] : {std::pair{"v 0 0\n", "three finite numbers"},
                                     {"v 0 0 x\n", "three finite numbers"},
                                     {"v 0 0 nan\n", "three finite numbers"},
                                     {"v 0 \\\n0 0\n", "three finite numbers"},
                                     {"v 0 0 0 2\n", "weight"},
                                     {"v 0 0 0\rv 0 0 1\n", "carriage return"}}) {
    const std::string e = error_of([&, text = std::string(line) + rest] {
      load_mesh(written("bad.obj", text), offset({1, 0, 0}));
    });
    EXPECT_NE(e.find("bad.obj: line 1: "), std::string::npos) << e;
    EXPECT_NE(e.find(reason), std::string::npos) << e;
  }
  EXPECT_EQ(error_of([&] {
              load_mesh(written("good.obj", "v +0.5 0 1 1\n" + rest), offset({1, 0, 0}));
            }),
            "");
  std::string odd = binary_ply<double>(tunnel_, Vec3::Zero(), "double", false);
  odd.replace(odd.find(" z\n"), 3, " w\n");
  EXPECT_NE(error_of([&] {
              load_mesh(written("odd.ply", odd), offset({1, 0, 0}));
            }).find("follow each other"),
            std::string::npos);
}

TEST_F(MeshFrames, OnlyVerticesAreMoved) {
  const auto moved = [&](const std::string& name, const std::string& bytes) {
    return cave::bytes_less_offset(written(name, bytes), offset({1, 2, 3}));
  };
  EXPECT_EQ(moved("a.obj", "# v 9 9 9\no v 9 9 9\nv 1 2 4\r\nvn 9 9 9\nv\t0 0 0 0.5 0.5 0.5\nf 1 2 3"),
            "# v 9 9 9\no v 9 9 9\nv 0 0 1\r\nvn 9 9 9\nv -1 -2 -3 0.5 0.5 0.5\nf 1 2 3");
  EXPECT_EQ(moved("a.stl", "solid vertex 1 2 3\nfacet normal 9 9 9 vertex 1 2 3 vertex 2 2 3\nendsolid\n"),
            "solid vertex 1 2 3\nfacet normal 9 9 9 vertex 0 0 0 vertex 1 0 0\nendsolid\n");
  const std::string head =
      "ply\nformat ascii 1.0\nelement camera 2\nproperty float f\nelement vertex 1\nproperty float q\n"
      "property float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(moved("b.stl", "solid a\r\n vertex 1 2 4\r\nendsolid a\r\n"),
            "solid a\r\n vertex 0 0 1\r\nendsolid a\r\n");
  const std::string dos =
      "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
      "property float z\r\nend_header\r\n";
  EXPECT_EQ(moved("b.ply", dos + "1.5 2 3\r\n"), dos + "0.5 0 0\r\n");
  EXPECT_EQ(moved("a.ply", head + "9\n9\n9 1.5 2 3\n3 0 0 0\n"), head + "9\n9\n9 0.5 0 0\n3 0 0 0\n");
}

TEST_F(MeshFrames, KeysThatMakeNoFrameAreRefused) {
  const auto error = [](const std::string& mesh, const core::MeshKeys& keys) {
    return error_of([&] { cave::mesh_frame("cave.info", mesh, keys); });
  };
  for (const char* bad : {"1 2", "1 2 3 4", "1 2 nan", "1 2 up", "inf 0 0"})
    EXPECT_EQ(error("a.ply", {1, MeshUnit::m, UpAxis::z, bad}).find("cave.info: offset: expected three"), 0u)
        << bad;
  EXPECT_EQ(error("a.dae", {}), "");
  EXPECT_EQ(error("a.dae", {0.001, MeshUnit::m, UpAxis::z, "1 2 3"}), "");
  EXPECT_EQ(error("a.DAE", {1, MeshUnit::mm, UpAxis::z, ""}).find("cave.info: unit: "), 0u);
  EXPECT_EQ(error("a.dae", {1, MeshUnit::m, UpAxis::y, ""}).find("cave.info: up: "), 0u);
}

RC_GTEST_PROP(MeshFrame, ThereAndBackIsTheSamePlace, ()) {
  const auto number = [](double reach) { return reach * *rc::gen::inRange(-10000, 10000) / 10000.0; };
  MeshFrame f;
  f.metres_per_unit = std::pow(10.0, number(3));
  f.up = *rc::gen::element(UpAxis::z, UpAxis::y);
  f.offset = Vec3(number(1e6), number(1e6), number(1e6));
  const Vec3 p(number(1e4), number(1e4), number(1e4));
  const Vec3 back = cave::to_metres(f, cave::to_file(f, p) - f.offset);
  RC_ASSERT((back - p).norm() <= 1e-9 * (p.norm() + 1e6 * f.metres_per_unit));
  // Distances scale, and the turn keeps a right-handed frame right-handed.
  const Vec3 x = cave::to_metres(f, Vec3(1, 0, 0)), y = cave::to_metres(f, Vec3(0, 1, 0)),
             z = cave::to_metres(f, Vec3(0, 0, 1));
  RC_ASSERT(std::abs(x.cross(y).dot(z) / std::pow(f.metres_per_unit, 3) - 1) < 1e-9);
  MeshFrame other = f;
  other.offset.z() += 1;
  RC_ASSERT(cave::to_text(other) != cave::to_text(f));
}

}  // namespace
}  // namespace karst::test
