#include "sdk/survey_export/las_points.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "core_stack/common/error.h"
#include "core_stack/common/little_endian.h"

namespace karst::survey_export {
namespace {

using core::append_bytes;
using core::Vec3;

constexpr double kScale_m = 0.001;
constexpr std::uint16_t kHeaderBytes = 227, kRecordBytes = 20;

void put_text(std::string& bytes, std::string text, std::size_t size) {
  text.resize(size, '\0');
  bytes += text;
}

std::int32_t steps(double v_m, double offset_m) {
  return static_cast<std::int32_t>(std::lround((v_m - offset_m) / kScale_m));
}

}  // namespace

std::string las_bytes(std::span<const Vec3> points, const std::string& file) {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    low = i == 0 ? points[i] : Vec3(low.cwiseMin(points[i]));
    high = i == 0 ? points[i] : Vec3(high.cwiseMax(points[i]));
  }
  const Vec3 offset = low.array().floor();
  if ((high - offset).maxCoeff() > kScale_m * std::numeric_limits<std::int32_t>::max() ||
      points.size() > std::numeric_limits<std::uint32_t>::max())
    throw core::InputError(file, "", "too many points, or too far apart, for LAS 1.2");
  const auto count = static_cast<std::uint32_t>(points.size());
  std::string bytes;
  bytes.reserve(kHeaderBytes + std::size_t{kRecordBytes} * points.size());
  bytes += "LASF";
  bytes.append(2 + 2 + 16, '\0');  // source, global encoding, project
  append_bytes(bytes, std::uint8_t{1});
  append_bytes(bytes, std::uint8_t{2});
  put_text(bytes, "OTHER", 32);  // system: neither a known sensor nor a merge
  put_text(bytes, "karst", 32);
  append_bytes(bytes, std::uint16_t{0});  // day and year of creation: unknown
  append_bytes(bytes, std::uint16_t{0});
  append_bytes(bytes, kHeaderBytes);
  append_bytes(bytes, std::uint32_t{kHeaderBytes});  // where the points begin
  append_bytes(bytes, std::uint32_t{0});             // no variable length records
  append_bytes(bytes, std::uint8_t{0});              // point format
  append_bytes(bytes, kRecordBytes);
  append_bytes(bytes, count);
  append_bytes(bytes, count);  // by return: all are first ones
  for (int i = 1; i < 5; ++i) append_bytes(bytes, std::uint32_t{0});
  for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, kScale_m);
  for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, offset[axis]);
  for (int axis = 0; axis < 3; ++axis) {
    append_bytes(bytes, offset[axis] + kScale_m * steps(high[axis], offset[axis]));  // as the points have it
    append_bytes(bytes, offset[axis] + kScale_m * steps(low[axis], offset[axis]));
  }
  for (const Vec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, steps(p[axis], offset[axis]));
    append_bytes(bytes, std::uint16_t{0});      // intensity
    append_bytes(bytes, std::uint8_t{0b1001});  // the first of one return
    append_bytes(bytes, std::uint8_t{1});       // unclassified
    append_bytes(bytes, std::uint8_t{0});       // scan angle
    append_bytes(bytes, std::uint8_t{0});       // user data
    append_bytes(bytes, std::uint16_t{0});      // source
  }
  return bytes;
}

}  // namespace karst::survey_export
