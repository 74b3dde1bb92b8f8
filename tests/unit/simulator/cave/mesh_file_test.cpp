#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <ctime>
#include <functional>

#include "plugins/simulator/cave/import_child.h"
#include "plugins/simulator/cave/triangle_mesh.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using cave::load_mesh;
using cave::TriangleMesh;

/// All triangles' corners in order, for comparing meshes whose vertices are numbered differently.
std::vector<std::array<float, 9>> corners(const TriangleMesh& m) {
  std::vector<std::array<float, 9>> all;
  for (const auto& t : m.triangles) {
    std::array<float, 9> c{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) c[3 * k + i] = m.vertices[t[k]][static_cast<int>(i)];
    all.push_back(c);
  }
  return all;
}

class MeshFiles : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// Loads a file with these bytes and returns the error.
  std::string error_for(const std::string& name, const std::string& bytes) const {
    write_bytes(path(name), bytes);
    return error_of([&] { load_mesh(path(name)); });
  }
  void expect_refused(const std::string& name, const std::string& bytes, const std::string& reason) const {
    const std::string error = error_for(name, bytes);
    EXPECT_NE(error.find(reason), std::string::npos)
        << name << ": \"" << error << "\" lacks \"" << reason << "\"";
    EXPECT_NE(error.find(name), std::string::npos) << "the error names the file: " << error;
  }
  std::string written(const std::string& name) const {
    cave::write_mesh(path(name), tunnel_);
    return read_bytes(path(name));
  }

  std::string folder_ = scratch_folder();
  TriangleMesh tunnel_ = tunnel_mesh(10, 2, 1);
};

TEST_F(MeshFiles, WrittenMeshesReadBackTheSame) {
  for (const char* name : {"a.ply", "a.stl"}) {
    cave::write_mesh(path(name), tunnel_);
    const TriangleMesh back = load_mesh(path(name));
    EXPECT_EQ(corners(back), corners(tunnel_)) << name;
    EXPECT_EQ(back.vertices.size(), tunnel_.vertices.size()) << "joined vertices, " << name;
  }
}

TEST_F(MeshFiles, TextFormatsAndObjAreRead) {
  const std::string obj = "v 0 0 1\nv 1 0 1\nv 0 1 3\nv 1 1 3\nf 1 2 3\nf 2 4 3\n";
  EXPECT_EQ(error_for("a.obj", obj), "");
  const TriangleMesh m = load_mesh(path("a.obj"));
  ASSERT_EQ(m.triangles.size(), 2u);
  EXPECT_EQ(m.vertices[m.triangles[0][2]], Vec3f(0, 1, 3)) << "z stays up";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(error_for("a.ply", ply), "");
  const std::string stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nendsolid a\n";
  EXPECT_EQ(error_for("a.stl", stl), "");
}

TEST_F(MeshFiles, PolygonsBecomeTriangles) {
  EXPECT_EQ(error_for("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), "");
  EXPECT_EQ(load_mesh(path("a.obj")).triangles.size(), 2u);
}

TEST_F(MeshFiles, ColladaAgreesWithItsStlTwin) {
  SKIP_WITHOUT_CAVES();
  const TriangleMesh dae = load_mesh(caves_folder() + "indian_tunnel.dae");
  const TriangleMesh stl = load_mesh(caves_folder() + "indian_tunnel.stl");
  ASSERT_EQ(dae.triangles.size(), stl.triangles.size());
  const cave::RayScene scene(stl);
  for (const Vec3f& v : dae.vertices) ASSERT_LT(scene.distance_to_rock(v.cast<double>(), 10), 1e-4);
}

/// A Collada file with one triangle, geometry "g", whose nodes are `library` and scene is `scene`.
std::string collada_of(const std::string& library, const std::string& scene) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<float_array id=\"pa\" count=\"9\">0 0 0 1 0 0 0 3 0</float_array><technique_common>"
         "<accessor source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
         "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common>"
         "</source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
         "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p>"
         "</triangles></mesh></geometry></library_geometries><library_nodes>" +
         library + "</library_nodes><library_visual_scenes><visual_scene id=\"s\">" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#s\"/></scene></COLLADA>";
}

// It ended the process: the importer follows such nodes until the stack is gone.
TEST_F(MeshFiles, ColladaNodesThatContainThemselvesAreRefused) {
  const std::string triangle = "<instance_geometry url=\"#g\"/>",
                    scene = "<node><instance_node url=\"#a\"/></node>";
  EXPECT_EQ(error_for("fine.dae", collada_of("<node id=\"a\">" + triangle + "</node>", scene)), "");
  expect_refused("self.dae",
                 collada_of("<node id=\"a\">" + triangle + "<instance_node url=\"#a\"/></node>", scene),
                 "is no mesh that can be read");
  expect_refused(
      "round.dae",
      collada_of("<node id=\"a\">" + triangle +
                     "<instance_node url=\"#b\"/></node><node id=\"b\"><instance_node url=\"#a\"/></node>",
                 scene),
      "is no mesh that can be read");
}

TEST_F(MeshFiles, ColladaNodesOfManyLevelsEndNothing) {
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "<node>";
  deep += "<instance_geometry url=\"#g\"/>";
  for (int i = 0; i < 200'000; ++i) deep += "</node>";
  expect_refused("deep.dae", collada_of("", deep), "");
}

TEST_F(MeshFiles, AnImportThatBreaksOrAsksForTooMuchIsAnError) {
  cave::write_mesh(path("a.ply"), tunnel_);
  const auto fault = [&](const std::function<TriangleMesh()>& import, cave::ImportLimits limits = {}) {
    return error_of([&] { cave::import_in_child(path("a.ply"), import, limits); });
  };
  const auto says = [](const std::string& e, const char* part) { return e.find(part) != std::string::npos; };
  const auto killed = []() -> TriangleMesh {
    std::raise(SIGKILL);
    return {};
  };
  EXPECT_TRUE(says(fault(killed), "a.ply: is no mesh that can be read: the importer broke on it (Killed)"));
  const std::string in_own_words = error_of([&] {
    cave::import_in_child(path("a.ply"), killed, {}, {"gives no surface", "PCL"});
  });
  EXPECT_TRUE(says(in_own_words, "a.ply: gives no surface: PCL broke on it (Killed)")) << in_own_words;
  const std::string slow = fault(
      []() -> TriangleMesh {
        while (std::clock() >= 0) continue;
        return {};
      },
      {0, 1});
  EXPECT_TRUE(says(slow, "processor time") || says(slow, "Killed")) << slow;
  EXPECT_TRUE(says(fault([]() -> TriangleMesh { throw std::bad_alloc(); }), "more memory"));
  EXPECT_TRUE(says(fault([]() -> TriangleMesh { _exit(0); }), "gave no answer"));
  EXPECT_TRUE(says(fault([] { return TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}; }), "makes no sense"));
  EXPECT_TRUE(
      says(fault([]() -> TriangleMesh { throw core::InputError("x", "", "own words"); }), "own words"));
}

// Two levels of 2^64 elements, and a list whose length wraps, kept the check itself busy for ever.
TEST_F(MeshFiles, APlyHeaderThatPromisesTooMuchIsRefusedAtOnce) {
  const std::string head = "ply\nformat binary_little_endian 1.0\n";
  expect_refused("nothing.ply", head + "element vertex 18446744073709551615\nend_header\n", "");
  expect_refused(
      "list.ply",
      head + "element face 18446744073709551615\nproperty list double double vertex_indices\nend_header\n" +
          std::string(64, '\xff'),
      "truncated");
}

// It was refused after ten minutes of processor time.
TEST_F(MeshFiles, AFewBytesThatSendTheImporterIntoAnEndlessLoopAreRefusedSoon) {
  const std::string text = "ply\nformat ascii .10\nenleemt vertex 3\nproperty float x\nproper\x12" +
                           std::string(1, '\0') + "0__cxxaindices\nend_header\x0b" + std::string(1, '\0') +
                           std::string(34, '\xfd');
  expect_refused("loop.ply", text, "processor time");
}

TEST_F(MeshFiles, AFifoIsNoMesh) {
  ASSERT_EQ(mkfifo(path("f.ply").c_str(), 0600), 0);
  alarm(20);  // instead of a test that waits for ever
  const std::string e = error_of([&] { load_mesh(path("f.ply")); });
  alarm(0);
  EXPECT_EQ(e, path("f.ply") + ": is a FIFO, not a regular file");
}

// The importer opened what an OBJ names as its materials, wherever that was, and waited for a FIFO.
TEST_F(MeshFiles, AFileThatAMeshNamesIsNotOpened) {
  ASSERT_EQ(mkfifo(path("materials").c_str(), 0600), 0);
  std::ofstream(path("m.obj")) << "mtllib materials\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  alarm(20);  // instead of a test that waits for ever
  EXPECT_EQ(load_mesh(path("m.obj")).triangles.size(), 1u);
  alarm(0);
}

TEST_F(MeshFiles, ColladaWithYUpIsTurned) {
  const auto collada = [](const std::string& axis) {
    return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
           "version=\"1.4.1\">"
           "<asset><unit name=\"centimeter\" meter=\"0.01\"/><up_axis>" +
           axis +
           "</up_axis></asset>"
           "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"9\">"
           "0 0 0 100 0 0 0 300 0</float_array><technique_common><accessor source=\"#pa\" count=\"3\" "
           "stride=\"3\">"
           "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
           "type=\"float\"/>"
           "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
           "source=\"#p\"/>"
           "</vertices><triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 "
           "2</p>"
           "</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene "
           "id=\"s\"><node>"
           "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
           "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
  };
  ASSERT_EQ(error_for("y.dae", collada("Y_UP")), "");
  ASSERT_EQ(error_for("z.dae", collada("Z_UP")), "");
  const TriangleMesh y = load_mesh(path("y.dae")), z = load_mesh(path("z.dae"));
  EXPECT_TRUE(y.vertices[2].isApprox(Vec3f(0, 0, 3), 1e-5f)) << y.vertices[2].transpose();
  EXPECT_TRUE(z.vertices[2].isApprox(Vec3f(0, 3, 0), 1e-5f)) << z.vertices[2].transpose();
}

TEST_F(MeshFiles, TruncatedFilesAreRefusedWhereverTheyEnd) {
  for (const char* name : {"t.stl", "t.ply", "t.Stl", "t.PlY"}) {
    const std::string whole = written(name);
    for (const double fraction : {0.02, 0.3, 0.5, 0.9, 0.999}) {
      const auto bytes = static_cast<std::size_t>(fraction * static_cast<double>(whole.size()));
      expect_refused(name, whole.substr(0, bytes), "truncated");
    }
    expect_refused(name, whole.substr(0, whole.size() - 1), "truncated");
  }
  expect_refused("text.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n",
                 "truncated");
  expect_refused(
      "text.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n",
      "truncated");
}

TEST_F(MeshFiles, EmptyFilesAndFilesWithoutTrianglesAreRefused) {
  for (const char* name : {"e.stl", "e.ply", "e.obj", "e.dae"}) expect_refused(name, "", "empty");
  expect_refused("no.stl", std::string(84, '\0'), "");
  expect_refused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "");
  expect_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle");
}

TEST_F(MeshFiles, VerticesThatAreNotFiniteAreRefused) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e20f}) {
    std::string stl = written("n.stl"), ply = written("n.ply");
    std::memcpy(stl.data() + 84 + 50 * 3 + 12, &bad, sizeof bad);
    expect_refused("n.stl", stl, "finite");
    std::memcpy(ply.data() + ply.find("end_header\n") + 11 + 24, &bad, sizeof bad);
    expect_refused("n.ply", ply, "finite");
  }
}

TEST_F(MeshFiles, FacesThatNameNoVertexAreRefused) {
  for (const std::uint32_t beyond : {1'000u, 1'000'000u, 0x7fffffffu, 0xffffffffu}) {
    std::string ply = written("i.ply");
    std::memcpy(ply.data() + ply.size() - 4, &beyond, sizeof beyond);
    expect_refused("i.ply", ply, "names a vertex that does not exist");
  }
}

TEST_F(MeshFiles, DamagedFilesAreReadOrRefusedButNeverCrash) {
  core::Random r(11);
  for (const char* name : {"d.ply", "d.stl"}) {
    const std::string whole = written(name);
    for (int i = 0; i < 150; ++i) {
      std::string bytes = whole;
      for (std::uint64_t k = 1 + r.bits() % 20; k > 0; --k) {
        const std::size_t reach = k % 2 == 0 ? bytes.size() : 400;  // headers matter more
        bytes[r.bits() % reach] = static_cast<char>(r.bits());
      }
      error_for(name, bytes);
    }
  }
}

TEST_F(MeshFiles, OtherFilesAreRefused) {
  expect_refused("a.txt", "hello", ".stl, .ply, .obj or .dae");
  expect_refused("not.ply", "hello, this is no mesh at all", "ply");
  expect_refused("not.stl", "hello", "truncated");
  expect_refused("not.dae", "<html></html>", "");
  expect_refused("not.obj", std::string("\x00\x01\x02garbage", 10), "");
  EXPECT_NE(error_of([&] { load_mesh(path("absent.ply")); }).find("absent.ply"), std::string::npos);
  EXPECT_NE(error_of([&] { load_mesh(folder_); }), "");
}

TEST_F(MeshFiles, WritingToNowhereIsAnError) {
  EXPECT_NE(error_of([&] { cave::write_mesh("/nowhere/at/all.ply", tunnel_); }).find("/nowhere/at/all.ply"),
            std::string::npos);
}

}  // namespace
}  // namespace karst::test
