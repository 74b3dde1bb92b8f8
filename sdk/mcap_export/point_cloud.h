// Point clouds whose points are rows of numbers.
#pragma once
#include <initializer_list>
#include <string>

#include "sdk/mcap_export/ros_messages.h"

namespace karst::ros {

/// PointField's numbers of types.
enum class PointType : std::uint8_t { uint8 = 2, uint16 = 4, uint32 = 6, float32 = 7, float64 = 8 };
constexpr std::uint32_t size_of(PointType type) {
  switch (type) {
    case PointType::uint8:
      return 1;
    case PointType::uint16:
      return 2;
    case PointType::uint32:
    case PointType::float32:
      return 4;
    case PointType::float64:
      return 8;
  }
  return 0;
}

struct PointColumn {
  const char* name;
  PointType type;
};

/// A cloud without points, whose fields follow each other without gaps.
inline PointCloud2 empty_cloud(Header header, std::initializer_list<PointColumn> columns) {
  PointCloud2 cloud;
  cloud.header = std::move(header);
  cloud.height = 1;
  for (const PointColumn& c : columns) {
    cloud.fields.push_back({c.name, cloud.point_step, static_cast<std::uint8_t>(c.type), 1});
    cloud.point_step += size_of(c.type);
  }
  cloud.is_dense = true;  // no position is NaN
  return cloud;
}

/// Appends the bytes of one field of a point.
template <class T>
void append(PointCloud2& cloud, T value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  cloud.data.insert(cloud.data.end(), bytes, bytes + sizeof value);
}

/// Once all points are in it.
inline PointCloud2 finished(PointCloud2 cloud) {
  cloud.row_step = static_cast<std::uint32_t>(cloud.data.size());
  cloud.width = cloud.row_step / cloud.point_step;
  return cloud;
}

}  // namespace karst::ros
