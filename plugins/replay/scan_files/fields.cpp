#include "plugins/replay/scan_files/fields.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>

#include "core_stack/common/error.h"

namespace karst::replay {
namespace {

template <class T>
double value_as(const char* raw) {
  T v;
  std::memcpy(&v, raw, sizeof v);
  return static_cast<double>(v);
}

std::string plain(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.starts_with("scalar_") ? name.substr(7) : name;
}

bool is_one_of(const std::string& name, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
}

}  // namespace

double value_at(const char* at, ValueType type, std::endian order) {
  std::array<char, 8> raw;
  const std::size_t n = size_of(type);
  std::memcpy(raw.data(), at, n);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(n));
  switch (type) {
    case ValueType::int8:
      return value_as<std::int8_t>(raw.data());
    case ValueType::uint8:
      return value_as<std::uint8_t>(raw.data());
    case ValueType::int16:
      return value_as<std::int16_t>(raw.data());
    case ValueType::uint16:
      return value_as<std::uint16_t>(raw.data());
    case ValueType::int32:
      return value_as<std::int32_t>(raw.data());
    case ValueType::uint32:
      return value_as<std::uint32_t>(raw.data());
    case ValueType::int64:
      return value_as<std::int64_t>(raw.data());
    case ValueType::uint64:
      return value_as<std::uint64_t>(raw.data());
    case ValueType::float32:
      return value_as<float>(raw.data());
    case ValueType::float64:
      return value_as<double>(raw.data());
  }
  return 0;
}

std::size_t size_of(ValueType type) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::optional<ValueType> type_named(const std::string& name) {
  constexpr std::array<std::array<const char*, 2>, 10> kNames = {{{"int8", "char"},
                                                                  {"uint8", "uchar"},
                                                                  {"int16", "short"},
                                                                  {"uint16", "ushort"},
                                                                  {"int32", "int"},
                                                                  {"uint32", "uint"},
                                                                  {"int64", "long"},
                                                                  {"uint64", "ulong"},
                                                                  {"float32", "float"},
                                                                  {"float64", "double"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<ValueType>(i);
  return std::nullopt;
}

Role role_of(const std::string& name, const FieldNames& names) {
  const std::string n = plain(name);
  if (n == "x") return Role::x;
  if (n == "y") return Role::y;
  if (n == "z") return Role::z;
  const auto is = [&](const std::string& own, std::initializer_list<const char*> usual) {
    return own.empty() ? is_one_of(n, usual) : name == own;
  };
  if (is(names.intensity, {"intensity", "i", "reflectivity", "reflectance", "remission"}))
    return Role::intensity;
  if (is(names.time, {"t", "time", "timestamp", "time_stamp", "offset_time", "time_offset", "gpstime"}))
    return Role::time;
  if (is(names.ring, {"ring", "channel", "laser", "line", "laserid", "scanline"})) return Role::ring;
  if (is_one_of(n, {"nx", "normal_x"})) return Role::normal_x;
  if (is_one_of(n, {"ny", "normal_y"})) return Role::normal_y;
  if (is_one_of(n, {"nz", "normal_z"})) return Role::normal_z;
  return Role::none;
}

std::string missing_coordinate(std::vector<Role>& roles) {
  std::set<Role> seen;
  for (Role& r : roles)
    if (r != Role::none && !seen.insert(r).second) r = Role::none;
  for (const auto& [role, name] : {std::pair{Role::x, "x"}, {Role::y, "y"}, {Role::z, "z"}})
    if (!seen.contains(role)) return name;
  return "";
}

void check_roles(std::vector<Role>& roles, const std::string& file, const std::string& place) {
  if (const std::string missing = missing_coordinate(roles); !missing.empty())
    throw core::InputError(file, place, "has no field " + missing);
}

void ScanBuilder::begin(std::span<const Field> fields) {
  for (const Field& f : fields) {
    scan_.has_intensity = scan_.has_intensity || f.role == Role::intensity;
    scan_.has_time = scan_.has_time || f.role == Role::time;
    scan_.has_ring = scan_.has_ring || f.role == Role::ring;
    if (f.role == Role::time) scan_.time_is_whole = is_whole(f.type);
  }
}

void ScanBuilder::set(Role role, double value) {
  switch (role) {
    case Role::x:
      point_.position.x() = static_cast<float>(value);
      break;
    case Role::y:
      point_.position.y() = static_cast<float>(value);
      break;
    case Role::z:
      point_.position.z() = static_cast<float>(value);
      break;
    case Role::intensity:
      point_.intensity = std::isfinite(value) ? static_cast<float>(value) : 0.0f;
      break;
    case Role::time:
      point_.time = value;
      finite_ = finite_ && std::isfinite(value);
      break;
    case Role::ring:
      finite_ = finite_ && value >= 0 && value <= 65535;
      point_.ring = static_cast<std::uint16_t>(finite_ ? value : 0);
      break;
    case Role::none:
    case Role::normal_x:
    case Role::normal_y:
    case Role::normal_z:
      break;
  }
}

void ScanBuilder::end_point() {
  if (finite_ && point_.position.allFinite()) {
    scan_.points.push_back(point_);
  } else {
    ++scan_.dropped;
  }
  finite_ = true;
}

void decode(std::span<const char> bytes, std::size_t count, const std::vector<Field>& fields,
            std::endian order, PointSink& sink) {
  std::vector<Field> used;
  std::copy_if(fields.begin(), fields.end(), std::back_inserter(used),
               [](const Field& f) { return f.role != Role::none; });
  sink.begin(used);
  for (std::size_t i = 0; i < count; ++i) {
    for (const Field& f : used)
      sink.set(f.role, value_at(bytes.data() + f.offset + i * f.stride, f.type, order));
    sink.end_point();
  }
}

std::vector<Field> text_fields(std::span<const Role> roles, std::span<const ValueType> types) {
  std::vector<Field> fields;
  for (std::size_t i = 0; i < roles.size(); ++i)
    fields.push_back({roles[i], types[i] == ValueType::float32 ? ValueType::float64 : types[i], 0, 0});
  return fields;
}

}  // namespace karst::replay
