#include "plugins/replay/bag/bag.h"

#include <array>
#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::replay {

bool is_bag(const std::string& path) {
  std::filesystem::path name(path);
  if (name.extension() == ".zstd") name = name.stem();  // by ROS 2, as a file
  const std::string ending = name.extension().string();
  return ending == ".bag" || ending == ".mcap" || ending == ".db3" || ending == ".active";
}

std::unique_ptr<Bag> open_bag(const std::string& path) {
  if (std::filesystem::is_directory(path)) return open_bag_folder(path);
  std::array<char, 16> head{};
  core::open_input(path, core::kMaxDataFileBytes).read(head.data(), head.size());
  const std::string_view start(head.data(), head.size());
  if (start.starts_with("#ROSBAG V2.0")) return open_rosbag1(path);
  if (start.starts_with("#ROSBAG"))
    throw core::InputError(path, "byte 0",
                           "is a bag of another version than 2.0: convert it with rosbag fix");
  if (start.starts_with("\x89MCAP")) return open_mcap(path);
  if (start.starts_with("SQLite format 3")) return open_db3(path);
  if (start.starts_with("\x28\xb5\x2f\xfd"))
    throw core::InputError(path, "byte 0", "is compressed as a file: decompress it first, by unzstd");
  if (start.front() == '\0' && std::filesystem::file_size(path) == 0)
    throw core::InputError(path, "", "is empty");
  throw core::InputError(path, "byte 0",
                         "is no bag: it begins neither as a ROS 1 bag, nor as MCAP, nor as SQLite (db3)");
}

std::string plain_type(std::string_view type) {
  std::string plain(type);
  const auto at = plain.find("/msg/");
  if (at != std::string::npos) plain.erase(at, 4);
  return plain;
}

}  // namespace karst::replay
