#include "sdk/map_merge/map_inputs.h"

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/map_merge/merge_maps.h"

namespace karst::map_merge {
namespace {

namespace fs = std::filesystem;
using core::InputError;

std::string file_of(const std::string& name) {
  if (!fs::is_directory(name)) return name;
  for (const char* map : {"map.ot", "map.bt", "map.ply"})
    if (fs::is_regular_file(fs::path(name) / map)) return (fs::path(name) / map).string();
  throw InputError(
      name, "", "holds no map.ot, map.bt or map.ply; karst recover makes them of a flight that was cut off");
}

std::string ply_bytes(const std::vector<core::Vec3f>& points) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(points.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const core::Vec3f& p : points)
    bytes.append(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float));
  return bytes;
}

/// A copy of a map: the merged map grows, the input stays unchanged.
std::shared_ptr<core::VoxelMap> copy_of(const core::VoxelMap& map) {
  core::MapOptions options;
  options.resolution_m = map.resolution_m();
  auto copy = std::make_shared<core::VoxelMap>(options);
  map.for_each_known(
      [&](const core::CellKey& k, core::Cell, float log_odds) { copy->assign(k, 1, log_odds); });
  return copy;
}

}  // namespace

MapInput read_map_input(const std::string& name, double resolution_m) {
  const std::string file = file_of(name);
  const std::string ending = fs::path(file).extension().string();
  try {
    if (ending == ".bt" || ending == ".ot")
      return {name, file, piece_of(std::make_shared<core::VoxelMap>(core::read_octomap(file)))};
    std::vector<core::Vec3f> points;
    for (const replay::ScanPoint& p : replay::read_scan(file).points) points.push_back(p.position);
    return {name, file, piece_of(points, resolution_m)};
  } catch (const std::invalid_argument& e) {
    throw InputError(file, "", e.what());
  }
}

MergedMap::MergedMap(const MapInput& first) : piece_(first.piece) {}

void MergedMap::add(const MapInput& map, const core::Pose& T_first_map) {
  if (piece_.cells && map.piece.cells) {
    const std::shared_ptr<core::VoxelMap> sum = copy_of(*piece_.cells);
    add_map(*sum, *map.piece.cells, T_first_map, {});
    piece_ = piece_of(sum);
    return;
  }
  std::vector<core::Vec3f> points = piece_.surface;
  for (const core::Vec3f& p : map.piece.surface)
    points.push_back((T_first_map * p.cast<double>()).cast<float>());
  piece_ = piece_of(points, std::min(piece_.resolution_m, map.piece.resolution_m));
}

std::vector<fs::path> MergedMap::write(const std::string& stem) const {
  std::vector<fs::path> files;
  try {
    if (piece_.cells) {
      files = {stem + ".ot", stem + ".bt"};
      core::write_octomap(*piece_.cells, stem);
    }
    files.emplace_back(stem + ".ply");
    evaluation::write_whole_file(files.back(), ply_bytes(piece_.surface));
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& f : files) fs::remove(f, ignored);
    throw;
  }
  return files;
}

}  // namespace karst::map_merge
