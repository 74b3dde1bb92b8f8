// Reads point clouds: .pcd (ascii, binary, binary_compressed), .ply (ascii, binary of either byte order) and
// .bin (bare records). Any damage is an InputError that names file, place and reason.
#pragma once
#include <string>
#include <vector>

#include "plugins/replay/scan_files/fields.h"

namespace karst::replay {

/// The layout of a bare .bin file, which has no header.
struct BinLayout {
  std::vector<std::string> names = {"x", "y", "z", "intensity"};  // KITTI's
  std::vector<ValueType> types = {ValueType::float32, ValueType::float32, ValueType::float32,
                                  ValueType::float32};
};

/// True for the endings .pcd, .ply and .bin.
bool is_scan_file(const std::string& path);

Scan read_scan(const std::string& path, const FieldNames& names = {}, const BinLayout& layout = {});

/// These give the points to `sink`, those that are not finite too.
void read_pcd(const std::string& path, const FieldNames& names, PointSink& sink);
/// Reads the element "vertex"; ignores later elements such as faces.
void read_ply(const std::string& path, const FieldNames& names, PointSink& sink);
void read_bin(const std::string& path, const FieldNames& names, const BinLayout& layout, PointSink& sink);

/// Number of faces that a .ply file's header declares; 0 for a point cloud.
std::size_t ply_faces(const std::string& path);

/// The file's bytes; throws InputError if it is missing, a directory, or unreadable.
std::string file_bytes(const std::string& path);

}  // namespace karst::replay
