#include "plugins/replay/bag/sensor_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/error.h"

namespace karst::replay {
namespace {

/// sensor_msgs/PointField: 1 to 8.
std::optional<ValueType> type_of_point_field(std::int64_t datatype) {
  using enum ValueType;
  constexpr std::array kTypes = {int8, uint8, int16, uint16, int32, uint32, float32, float64};
  if (datatype < 1 || datatype > static_cast<std::int64_t>(kTypes.size())) return std::nullopt;
  return kTypes[static_cast<std::size_t>(datatype - 1)];
}

/// A count or an offset. The bag's own definition may give the member any type; the real one has 32 bits.
std::uint64_t count_of(const Message& m, const std::string& path) {
  const std::int64_t count = m.whole(path);
  if (count < 0 || count > std::numeric_limits<std::uint32_t>::max())
    throw MalformedError("its " + path + " of " + std::to_string(count) + " is no count of 32 bits", 0);
  return static_cast<std::uint64_t>(count);
}

struct NamedFields {
  std::vector<std::string> names;
  std::vector<Field> fields;
};

/// Gives each field its role; throws MalformedError without x, y and z.
void assign_roles(NamedFields& f, const FieldNames& names) {
  std::vector<Role> roles;
  for (const std::string& name : f.names) roles.push_back(role_of(name, names));
  if (const std::string missing = missing_coordinate(roles); !missing.empty())
    throw MalformedError("the points have no field " + missing, 0);
  for (std::size_t i = 0; i < roles.size(); ++i) f.fields[i].role = roles[i];
}

NamedFields fields_of_cloud(const Message& m, const FieldNames& names) {
  NamedFields result;
  const std::uint64_t step = count_of(m, "point_step");
  for (const Message& field : m.structures("fields")) {
    const std::string name(field.text("name"));
    const auto type = type_of_point_field(field.whole("datatype"));
    if (!type && role_of(name, names) == Role::none) continue;  // not used
    if (!type)
      throw MalformedError(
          "the field " + name + " has the unknown type " + std::to_string(field.whole("datatype")), 0);
    const std::uint64_t offset = count_of(field, "offset");
    if (offset + size_of(*type) > step)
      throw MalformedError(
          "the field " + name + " lies beyond the " + std::to_string(step) + " bytes of a point", 0);
    result.names.push_back(name);
    result.fields.push_back({Role::none, *type, offset, step});
  }
  assign_roles(result, names);
  return result;
}

NamedFields fields_of_livox(const Message::Records& records, const FieldNames& names) {
  NamedFields result;
  for (const auto& [name, field] : records.fields) {
    result.names.push_back(name);
    result.fields.push_back(field);
  }
  assign_roles(result, names);
  return result;
}

bool is_livox(std::string_view type) { return type.ends_with("/CustomMsg"); }

core::Vec3 vector_of(const Message& m, const std::string& path) {
  return {m.number(path + ".x"), m.number(path + ".y"), m.number(path + ".z")};
}
core::Quat rotation_of_message(const Message& m, const std::string& path) {
  const core::Quat q(m.number(path + ".w"), m.number(path + ".x"), m.number(path + ".y"),
                     m.number(path + ".z"));
  const double norm = q.norm();
  if (!std::isfinite(norm) || norm < 0.5 || norm > 2)
    throw MalformedError("a rotation is no unit quaternion", 0);
  return q.normalized();
}

}  // namespace

Message MessageDecoder::decode(std::size_t connection, Bytes bytes) {
  const Connection& c = connections_->at(connection);
  if (c.encoding == Encoding::unknown)
    throw MalformedError("its encoding is neither CDR nor that of ROS 1", 0);
  const Dialect dialect = c.encoding == Encoding::ros1 ? Dialect::ros1 : Dialect::ros2;
  auto type = types_.find(connection);
  if (type == types_.end()) {
    const std::string definition = c.definition.empty() ? known_definition(c.type, dialect) : c.definition;
    if (definition.empty()) throw MalformedError("the type " + c.type + " is neither defined nor known", 0);
    type = types_.emplace(connection, parse_message_type(c.type, definition, dialect)).first;
  }
  return Message::of(type->second, bytes, dialect);
}

bool is_cloud_type(std::string_view type) {
  return type == "sensor_msgs/PointCloud2" || type == "livox_ros_driver/CustomMsg" ||
         type == "livox_ros_driver2/CustomMsg";
}

core::TimeNs stamp_of(const Message& m) {
  return static_cast<core::TimeNs>(count_of(m, "header.stamp.sec")) * core::kSecond +
         static_cast<core::TimeNs>(count_of(m, "header.stamp.nanosec"));
}
std::string frame_of(const Message& m) {
  std::string frame(m.text("header.frame_id"));
  if (frame.starts_with('/')) frame.erase(0, 1);  // of the first tf
  return frame;
}

CloudMessage cloud_of(std::string_view type, const Message& m, const FieldNames& names) {
  CloudMessage cloud{stamp_of(m), frame_of(m), {}, 0};
  ScanBuilder builder;
  if (is_livox(type)) {
    const Message::Records records = m.records("points");
    const NamedFields f = fields_of_livox(records, names);
    decode(records.bytes, records.count, f.fields, m.order(), builder);
  } else {
    const NamedFields f = fields_of_cloud(m, names);
    const std::uint64_t height = count_of(m, "height"), width = count_of(m, "width"),
                        step = count_of(m, "point_step");
    // Drivers of clouds of one row do not always fill in row_step.
    const std::uint64_t row = height > 1 ? count_of(m, "row_step") : width * step;
    const Bytes data = m.numbers("data", ValueType::uint8);
    const auto order = m.whole("is_bigendian") != 0 ? std::endian::big : std::endian::little;
    // Each of the four has 32 bits: products do not overflow.
    if (row < width * step || (height > 0 && width > 0 && (height - 1) * row + width * step > data.size()))
      throw MalformedError("its " + std::to_string(data.size()) + " bytes of data are fewer than " +
                               std::to_string(height) + " rows of " + std::to_string(width) + " points of " +
                               std::to_string(step) + " bytes",
                           0);
    if (row == width * step) {
      decode(data, height * width, f.fields, order, builder);
    } else {
      for (std::uint64_t r = 0; r < height && width > 0; ++r)
        decode(data.subspan(r * row), width, f.fields, order, builder);
    }
  }
  cloud.scan = builder.take();
  cloud.declared = cloud.scan.points.size() + cloud.scan.dropped;
  return cloud;
}

std::vector<CloudField> cloud_fields(std::string_view type, const Message& m, const FieldNames& names) {
  const NamedFields f =
      is_livox(type) ? fields_of_livox(m.records("points"), names) : fields_of_cloud(m, names);
  std::vector<CloudField> result;
  for (std::size_t i = 0; i < f.fields.size(); ++i)
    result.push_back({f.names[i], f.fields[i].type, f.fields[i].role});
  return result;
}

core::ImuSample imu_of(const Message& m) {
  const core::ImuSample sample{stamp_of(m), vector_of(m, "linear_acceleration"),
                               vector_of(m, "angular_velocity")};
  if (!sample.specific_force_mps2.allFinite() || !sample.body_rate_radps.allFinite())
    throw MalformedError("its numbers are not finite", 0);
  return sample;
}

std::vector<FrameTransform> transforms_of(const Message& m) {
  std::vector<FrameTransform> result;
  for (const Message& t : m.structures("transforms")) {
    std::string child(t.text("child_frame_id"));
    if (child.starts_with('/')) child.erase(0, 1);
    result.push_back({frame_of(t),
                      std::move(child),
                      {vector_of(t, "transform.translation"), rotation_of_message(t, "transform.rotation")}});
  }
  return result;
}

std::optional<core::Pose> find_transform(const std::vector<FrameTransform>& transforms,
                                         const std::string& from, const std::string& to) {
  std::map<std::string, core::Pose> reached{{from, core::Pose{}}};
  for (bool grew = true; grew && !reached.contains(to);) {
    grew = false;
    for (const FrameTransform& t : transforms) {
      const auto parent = reached.find(t.parent), child = reached.find(t.child);
      if (parent != reached.end() && child == reached.end())
        grew = reached.emplace(t.child, parent->second * t.T_parent_child).second;
      else if (child != reached.end() && parent == reached.end())
        grew = reached.emplace(t.parent, child->second * t.T_parent_child.inverse()).second;
    }
  }
  const auto found = reached.find(to);
  return found == reached.end() ? std::nullopt : std::optional(found->second);
}

StampedPose pose_of(std::string_view type, const Message& m) {
  const std::string path = type == "nav_msgs/Odometry" ? "pose.pose" : "pose";
  return {stamp_of(m), {vector_of(m, path + ".position"), rotation_of_message(m, path + ".orientation")}};
}

}  // namespace karst::replay
