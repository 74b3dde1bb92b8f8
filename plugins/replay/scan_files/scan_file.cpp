#include "plugins/replay/scan_files/scan_file.h"

#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::replay {

using core::InputError;

std::string file_bytes(const std::string& path) { return core::read_input(path, core::kMaxScanFileBytes); }

bool is_scan_file(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".pcd" || ending == ".ply" || ending == ".bin";
}

Scan read_scan(const std::string& path, const FieldNames& names, const BinLayout& layout) {
  const std::string ending = std::filesystem::path(path).extension().string();
  ScanBuilder builder;
  if (ending == ".pcd")
    read_pcd(path, names, builder);
  else if (ending == ".ply")
    read_ply(path, names, builder);
  else if (ending == ".bin")
    read_bin(path, names, layout, builder);
  else
    throw InputError(path, "", "a point cloud must be a .pcd, .ply or .bin file");
  return builder.take();
}

void read_bin(const std::string& path, const FieldNames& names, const BinLayout& layout, PointSink& sink) {
  const std::string bytes = file_bytes(path);
  std::vector<Role> roles;
  for (const std::string& n : layout.names) roles.push_back(role_of(n, names));
  check_roles(roles, path, "fields");
  std::size_t record = 0;
  std::vector<Field> fields;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    fields.push_back({roles[i], layout.types[i], record, 0});
    record += size_of(layout.types[i]);
  }
  for (Field& f : fields) f.stride = record;
  if (bytes.size() % record != 0)
    throw InputError(path, "byte " + std::to_string(bytes.size() - bytes.size() % record),
                     "ends within a record: its " + std::to_string(bytes.size()) +
                         " bytes are no multiple of the " + std::to_string(record) + " of a point");
  decode(bytes, bytes.size() / record, fields, std::endian::little, sink);
}

}  // namespace karst::replay
