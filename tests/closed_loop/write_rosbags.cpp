// write_rosbags SCANS OUT: writes what a flight with record.scans recorded as bags, by ROS 1's own library
// with its own messages: OUT/none.bag, bz2.bag, lz4.bag, and unclosed.bag, which is none.bag while it is
// being recorded. ROS 1's headers are C++17.
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace {

namespace fs = std::filesystem;
using rosbag::compression::CompressionType;

constexpr const char* kFrame = "base_link";

ros::Time time_of(std::uint64_t ns) {
  return {static_cast<std::uint32_t>(ns / 1'000'000'000), static_cast<std::uint32_t>(ns % 1'000'000'000)};
}

sensor_msgs::PointCloud2 cloud_of(const fs::path& pcd, std::uint64_t stamp) {
  constexpr std::string_view kData = "DATA binary\n";
  std::ostringstream all;
  all << std::ifstream(pcd, std::ios::binary).rdbuf();
  const std::string bytes = all.str();
  const std::size_t data = bytes.find(kData) + kData.size();
  if (bytes.substr(0, data).find("FIELDS x y z intensity t ring\n") == std::string::npos)
    throw std::runtime_error(pcd.string() + " has other fields");
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = time_of(stamp);
  cloud.header.frame_id = kFrame;
  using sensor_msgs::PointField;
  std::uint32_t offset = 0;
  for (const auto& [name, type, size] : {std::tuple{"x", PointField::FLOAT32, 4u},
                                         {"y", PointField::FLOAT32, 4u},
                                         {"z", PointField::FLOAT32, 4u},
                                         {"intensity", PointField::FLOAT32, 4u},
                                         {"t", PointField::UINT32, 4u},
                                         {"ring", PointField::UINT16, 2u}}) {
    PointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = static_cast<std::uint8_t>(type);
    field.count = 1;
    cloud.fields.push_back(field);
    offset += size;
  }
  cloud.height = 1;
  cloud.point_step = offset;
  cloud.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(data), bytes.end());
  cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());
  cloud.width = cloud.row_step / cloud.point_step;
  cloud.is_dense = 1;
  return cloud;
}

/// What a recorder beside the vehicle would have written: a scan 10 ms after its end, IMU samples at once.
void write(rosbag::Bag& bag, const fs::path& scans) {
  std::map<std::uint64_t, fs::path> clouds;  // by time of recording
  for (const auto& entry : fs::directory_iterator(scans))
    if (entry.path().extension() == ".pcd")
      clouds.emplace(std::stoull(entry.path().stem().string()) + 110'000'000, entry.path());
  auto cloud = clouds.begin();
  const auto write_clouds_until = [&](std::uint64_t time) {
    for (; cloud != clouds.end() && cloud->first < time; ++cloud)
      bag.write("/os/points", time_of(cloud->first), cloud_of(cloud->second, cloud->first - 110'000'000));
  };
  std::ifstream lines(scans / "imu.csv");
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line);) {
    unsigned long long s = 0, ns = 0;
    sensor_msgs::Imu imu;
    auto &a = imu.linear_acceleration, &w = imu.angular_velocity;
    if (std::sscanf(line.c_str(), "%llu.%9llu,%lf,%lf,%lf,%lf,%lf,%lf", &s, &ns, &a.x, &a.y, &a.z, &w.x, &w.y,
                    &w.z) != 8)
      throw std::runtime_error("imu.csv: " + line);
    const std::uint64_t time = s * 1'000'000'000 + ns;
    write_clouds_until(time);
    imu.header.stamp = time_of(time);
    imu.header.frame_id = kFrame;
    bag.write("/os/imu", time_of(time), imu);
  }
  write_clouds_until(~std::uint64_t{0});
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const fs::path scans = argv[1], out = argv[2];
  for (const auto& [name, compression] : {std::pair{"none.bag", CompressionType::Uncompressed},
                                          {"bz2.bag", CompressionType::BZ2},
                                          {"lz4.bag", CompressionType::LZ4}}) {
    rosbag::Bag bag((out / name).string(), rosbag::bagmode::Write);
    bag.setCompression(compression);
    write(bag, scans);
    if (compression == CompressionType::Uncompressed) fs::copy_file(out / name, out / "unclosed.bag");
    bag.close();
  }
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
