#include <octomap/octomap.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"

namespace karst::core {
namespace {

/// Opens a temporary file, lets `write` fill it, and renames it to `path` once all is written.
template <class Write>
void write_whole(const std::string& path, Write&& write) {
  const std::string temporary = path + ".part";
  const auto fail = [&](const std::string& what) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "write error";
    std::remove(temporary.c_str());
    throw InputError(path, "", what + ": " + reason);
  };
  std::remove(temporary.c_str());  // left by a killed flight, or a FIFO that would block
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  if (!out) fail("cannot be created");
  write(out);
  out.close();  // flushes; a full disk may become apparent only here
  if (!out) fail("cannot be written");
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot be put in place");
}

/// OctoMap's own functions that write a header also print to the terminal.
void write_header(std::ostream& out, const char* kind, const octomap::OcTree& tree) {
  char resolution[32];
  const auto end = std::to_chars(resolution, resolution + sizeof resolution, tree.getResolution()).ptr;
  out << kind << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
      << std::string_view(resolution, end) << "\ndata\n";
}

}  // namespace

void write_octomap(const VoxelMap& map, const std::string& stem) {
  const auto tree = to_octree(map);
  write_whole(stem + ".ot", [&](std::ostream& out) {
    write_header(out, "# Octomap OcTree file", *tree);
    if (tree->size() > 0) tree->writeData(out);
  });
  tree->toMaxLikelihood();  // converts to classes, of which more can be pruned
  tree->prune();
  write_whole(stem + ".bt", [&](std::ostream& out) {
    write_header(out, "# Octomap OcTree binary file", *tree);
    if (tree->size() > 0) tree->writeBinaryData(out);
  });
}

void write_ply(const VoxelMap& map, const std::string& path) {
  static_assert(std::endian::native == std::endian::little, "the header says so");
  write_whole(path, [&](std::ostream& out) {
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << map.occupied_cells()
        << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    map.for_each_known([&](const CellKey& k, Cell cell, float) {
      if (cell != Cell::occupied) return;
      const Vec3f p = map.center_of(k).cast<float>();
      out.write(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float));
    });
  });
}

}  // namespace karst::core
