#include "sdk/mcap_export/markers.h"

#include <utility>

#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

using core::Vec3;

// visualization_msgs/Marker's numbers.
constexpr std::int32_t kArrow = 0, kSphere = 2, kLineList = 5, kPoints = 8, kTextFacing = 9;
constexpr std::int32_t kAdd = 0, kDeleteAll = 3;

constexpr double kLine_m = 0.05, kPoint_m = 0.15, kTextHeight_m = 0.25;

}  // namespace

Markers::Markers(ros::Header header) : header_(std::move(header)) {
  ros::Marker& all = array_.markers.emplace_back();
  all.header = header_;
  all.action = kDeleteAll;
}

ros::Marker& Markers::add(const char* group, std::uint32_t id, std::int32_t type, const Colour& c) {
  ros::Marker& m = array_.markers.emplace_back();
  m.header = header_;
  m.ns = group;
  m.id = static_cast<std::int32_t>(id);
  m.type = type;
  m.action = kAdd;
  m.color = {c.r, c.g, c.b, c.a};
  m.frame_locked = true;  // moves with its frame
  return m;
}

void Markers::sphere(const char* group, std::uint32_t id, const Vec3& at, double diameter_m,
                     const Colour& c) {
  ros::Marker& m = add(group, id, kSphere, c);
  m.pose.position = ros::point(at);
  m.scale = {diameter_m, diameter_m, diameter_m};
}

void Markers::arrow(const char* group, std::uint32_t id, const core::Pose& from, double length_m,
                    const Colour& c) {
  ros::Marker& m = add(group, id, kArrow, c);
  m.pose = ros::pose(from);
  m.scale = {length_m, length_m / 10, length_m / 10};
}

void Markers::text(const char* group, std::uint32_t id, const Vec3& at, const std::string& text,
                   const Colour& c) {
  ros::Marker& m = add(group, id, kTextFacing, c);
  m.pose.position = ros::point(at);
  m.scale.z = kTextHeight_m;
  m.text = text;
}

void Markers::points(const char* group, std::uint32_t id, std::span<const Vec3> points, const Colour& c) {
  ros::Marker& m = add(group, id, kPoints, c);
  m.scale = {kPoint_m, kPoint_m, 0};
  for (const Vec3& p : points) m.points.push_back(ros::point(p));
}

void Markers::lines(const char* group, std::uint32_t id, std::span<const Vec3> points, const Colour& c) {
  ros::Marker& m = add(group, id, kLineList, c);
  m.scale.x = kLine_m;
  for (const Vec3& p : points.first(points.size() / 2 * 2)) m.points.push_back(ros::point(p));
}

}  // namespace karst::mcap
