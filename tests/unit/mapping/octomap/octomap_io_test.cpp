#include "core_stack/mapping/octomap/octomap_io.h"

#include <gtest/gtest.h>
#include <octomap/octomap.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core_stack/common/error.h"
#include "tests/unit/mapping/scenes.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

class OctomapIo : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("karst_octomap_io_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string bytes_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  fs::path folder_;
};

VoxelMap some_map() {
  Random random(19);
  VoxelMap map{MapOptions{}};
  for (int i = 0; i < 4; ++i) {
    const Vec3 origin(0.5 + i, 0.2, 1.3);
    map.insert(scenes::room_scan(origin, Vec3(-3, -3, 0), Vec3(7, 3, 3), 1500, 6, 0.02, random));
  }
  map.assign({-64, -64, -64}, 16, -1.9f);  // large enough to be pruned to one node
  return map;
}

using Known = std::vector<std::tuple<CellKey, Cell, float>>;
Known known(const VoxelMap& map) {
  Known all;
  map.for_each_known([&](const CellKey& k, Cell c, float v) { all.emplace_back(k, c, v); });
  return all;
}

void expect_same_cells(const VoxelMap& map, const octomap::OcTree& tree, double tolerance) {
  std::size_t leaves = 0;
  for (auto it = tree.begin_leafs(); it != tree.end_leafs(); ++it)
    leaves += std::size_t{1} << 3 * (16 - it.getDepth());
  EXPECT_EQ(leaves, map.free_cells() + map.occupied_cells());
  map.for_each_known([&](const CellKey& k, Cell c, float v) {
    const auto part = [](int x) { return static_cast<octomap::key_type>(x + 32768); };
    const auto* node = tree.search(octomap::OcTreeKey(part(k.x), part(k.y), part(k.z)));
    ASSERT_NE(node, nullptr);
    EXPECT_EQ(tree.isNodeOccupied(node), c == Cell::occupied);
    EXPECT_NEAR(node->getLogOdds(), v, tolerance);
  });
}

TEST_F(OctomapIo, TheTreeHoldsTheSameLogOddsPrunedAndSummedUp) {
  const VoxelMap map = some_map();
  const auto tree = to_octree(map);
  expect_same_cells(map, *tree, 0);
  // What OctoMap makes of the same cells by its own means.
  octomap::OcTree reference(map.resolution_m());
  map.for_each_known([&](const CellKey& k, Cell, float v) {
    const auto part = [](int x) { return static_cast<octomap::key_type>(x + 32768); };
    reference.setNodeValue(octomap::OcTreeKey(part(k.x), part(k.y), part(k.z)), v, true);
  });
  reference.updateInnerOccupancy();
  reference.prune();
  EXPECT_EQ(tree->size(), reference.size());
  EXPECT_TRUE(*tree == reference);
}

TEST_F(OctomapIo, OctoMapsOwnReaderReadsWhatWeWrite) {
  const VoxelMap map = some_map();
  write_octomap(map, path("map"));
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(path("map.ot")));
  const auto* values = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(values, nullptr);
  expect_same_cells(map, *values, 0);
  const octomap::OcTree classes(path("map.bt"));
  expect_same_cells(map, classes, 10);
}

TEST_F(OctomapIo, WeReadWhatWeWrite) {
  const VoxelMap map = some_map();
  write_octomap(map, path("map"));
  EXPECT_EQ(known(read_octomap(path("map.ot"))), known(map));
  const VoxelMap classes = read_octomap(path("map.bt"));
  EXPECT_EQ(classes.free_cells(), map.free_cells());
  EXPECT_EQ(classes.occupied_cells(), map.occupied_cells());
  map.for_each_known([&](const CellKey& k, Cell c, float) { EXPECT_EQ(classes.at(k), c); });
  EXPECT_FALSE(fs::exists(path("map.bt.part")));
}

TEST_F(OctomapIo, AnEmptyMapMakesTheRoundTrip) {
  const VoxelMap map{MapOptions{}};
  EXPECT_EQ(to_octree(map)->size(), 0u);
  write_octomap(map, path("empty"));
  for (const char* name : {"empty.bt", "empty.ot"}) {
    const VoxelMap read = read_octomap(path(name));
    EXPECT_EQ(read.free_cells() + read.occupied_cells(), 0u);
    EXPECT_EQ(read.resolution_m(), 0.2);
  }
}

TEST_F(OctomapIo, TheCornersOfTheWorldMakeTheRoundTrip) {
  VoxelMap map{MapOptions{}};
  for (const int x : {-32768, 32767})
    for (const int y : {-32768, 32767})
      for (const int z : {-32768, 32767}) map.assign({x, y, z}, 1, 0.5f);
  write_octomap(map, path("corners"));
  EXPECT_EQ(known(read_octomap(path("corners.ot"))), known(map));
}

TEST_F(OctomapIo, ReadsTheMapsOfOthersAsOctoMapDoes) {
  const fs::path maps = fs::path(KARST_SOURCE_DIR) / "../shared/data/maps";
  if (!fs::exists(maps)) GTEST_SKIP() << "skipped: no ../shared";
  const std::string file = (maps / "geb079.bt").string();
  const VoxelMap map = read_octomap(file);
  octomap::OcTree tree(file);
  std::size_t free = 0, occupied = 0;
  for (auto it = tree.begin_leafs(); it != tree.end_leafs(); ++it)
    (tree.isNodeOccupied(*it) ? occupied : free) += std::size_t{1} << 3 * (16 - it.getDepth());
  EXPECT_EQ(map.free_cells(), free);
  EXPECT_EQ(map.occupied_cells(), occupied);
  const auto ours = to_octree(map);
  for (octomap::OcTree* t : {ours.get(), &tree}) {  // the clamping values differ in the last digits
    t->toMaxLikelihood();
    t->prune();
  }
  EXPECT_TRUE(*ours == tree);
}

TEST_F(OctomapIo, AFileCutShortAnywhereIsAnError) {
  write_octomap(some_map(), path("map"));
  Random random(3);
  for (const char* name : {"map.bt", "map.ot"}) {
    const std::string whole = bytes_of(path(name));
    for (int i = 0; i < 150; ++i) {
      const auto length =
          i < 120 ? static_cast<std::size_t>(i)
                  : static_cast<std::size_t>(random.uniform() * static_cast<double>(whole.size()));
      EXPECT_THROW(read_octomap(write("cut", whole.substr(0, length))), InputError)
          << name << " cut at " << length;
    }
  }
}

TEST_F(OctomapIo, DamagedBytesAreAnErrorOrAMapButNeverACrash) {
  Random data(8);
  VoxelMap small{MapOptions{}};
  small.insert(scenes::room_scan(Vec3(0, 0, 1), Vec3(-2, -2, 0), Vec3(2, 2, 2), 200, 6, 0, data));
  write_octomap(small, path("map"));
  Random random(4);
  int refused = 0;
  for (const char* name : {"map.bt", "map.ot"}) {
    const std::string whole = bytes_of(path(name));
    for (int i = 0; i < 200; ++i) {
      std::string damaged = whole;
      for (int n = 0; n < 3; ++n) damaged[random.bits() % damaged.size()] = static_cast<char>(random.bits());
      try {
        read_octomap(write("damaged", damaged));
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 200);
}

TEST_F(OctomapIo, ErrorsNameTheFileThePlaceAndTheReason) {
  const auto message = [](const std::string& file) -> std::string {
    try {
      read_octomap(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  const std::string head = "# Octomap OcTree binary file\nid OcTree\nsize 1\n";
  EXPECT_EQ(message(path("none.bt")), path("none.bt") + ": cannot be opened: no such file");
  EXPECT_EQ(message(write("a", "ply\n")), path("a") + ": line 1: is no OctoMap .bt or .ot file");
  EXPECT_EQ(message(write("b", head + "res -1\ndata\n")),
            path("b") + ": res: expected the edge length of a cell, in metres");
  EXPECT_EQ(message(write("c", head + "res 0.2\ndata\nx")), path("c") + ": byte 59: ends within its tree");
  EXPECT_EQ(message(write("d", "# Octomap OcTree file\nid ColorOcTree\n")),
            path("d") + ": id: expected a tree of kind OcTree, got ColorOcTree");
  // One inner child below another, deeper than OctoMap's trees are.
  std::string deep = head + "res 0.2\ndata\n";
  for (int i = 0; i < 100000; ++i) deep += std::string("\x03\x00", 2);
  EXPECT_NE(message(write("e", deep)).find("deeper than 16 levels"), std::string::npos);
  // Half the world in one leaf.
  EXPECT_NE(message(write("f", head + "res 0.2\ndata\n" + std::string("\x01\x00", 2))).find("300 million"),
            std::string::npos);
}

TEST_F(OctomapIo, AFullDiskIsAnErrorAndLeavesTheOldFileWhole) {
  VoxelMap small{MapOptions{}};
  small.assign({0, 0, 0}, 1, 1.0f);
  write_octomap(small, path("map"));
  write_ply(small, path("map.ply"));
  const std::string ot = bytes_of(path("map.ot")), ply = bytes_of(path("map.ply"));

  const VoxelMap large = some_map();
  rlimit former{};
  getrlimit(RLIMIT_FSIZE, &former);
  const rlimit full{4096, former.rlim_max};  // writes beyond 4 kB fail, as on a full disk
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &full);
  std::string error;
  try {
    write_octomap(large, path("map"));
  } catch (const InputError& e) {
    error = e.what();
  }
  EXPECT_THROW(write_ply(large, path("map.ply")), InputError);
  setrlimit(RLIMIT_FSIZE, &former);
  std::signal(SIGXFSZ, handler);

  EXPECT_EQ(error, path("map.ot") + ": cannot be written: File too large");
  EXPECT_EQ(bytes_of(path("map.ot")), ot);
  EXPECT_EQ(bytes_of(path("map.ply")), ply);
  EXPECT_FALSE(fs::exists(path("map.ot.part")));
  EXPECT_THROW(write_ply(large, path("no/such/folder.ply")), InputError);
}

TEST_F(OctomapIo, ThePlyHoldsTheOccupiedCentres) {
  VoxelMap map{MapOptions{}};
  map.assign({0, 0, 0}, 1, 1.0f);
  map.assign({-5, 7, 2}, 1, 1.0f);
  map.assign({1, 0, 0}, 1, -1.0f);
  write_ply(map, path("map.ply"));
  const std::string bytes = bytes_of(path("map.ply"));
  const std::size_t header = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("element vertex 2\n"), std::string::npos);
  ASSERT_EQ(bytes.size(), header + 2 * 3 * sizeof(float));
  float p[6];
  std::memcpy(p, bytes.data() + header, sizeof p);
  EXPECT_NEAR((Vec3f(p[0], p[1], p[2]) - Vec3f(-0.9f, 1.5f, 0.5f)).norm(), 0, 1e-5);
  EXPECT_NEAR((Vec3f(p[3], p[4], p[5]) - Vec3f(0.1f, 0.1f, 0.1f)).norm(), 0, 1e-5);
}

}  // namespace
}  // namespace karst::core
