// Which fields of a record are a point's coordinates, intensity, time and ring, and how they are stored.
#pragma once
#include <bit>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "plugins/replay/scan_files/scan.h"

namespace karst::replay {

enum class ValueType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t size_of(ValueType type);
inline bool is_whole(ValueType type) { return type < ValueType::float32; }
/// The type named "float32", "uint16" ...; also PLY's "float", "ushort" ...; nullopt if unknown.
std::optional<ValueType> type_named(const std::string& name);

enum class Role { none, x, y, z, intensity, time, ring, normal_x, normal_y, normal_z };

/// Names of a file's fields where they are not the usual ones; "" for the usual ones.
struct FieldNames {
  std::string intensity, time, ring;
};
/// Usual names: x y z; intensity, i, reflectivity; t, time, timestamp, ...; ring, channel, laser; nx,
/// normal_x (any case, also with CloudCompare's "scalar_" before them).
Role role_of(const std::string& name, const FieldNames& names);

/// The location of a field: in record i it starts at byte `offset + i * stride`.
struct Field {
  Role role = Role::none;
  ValueType type = ValueType::float32;
  std::size_t offset = 0, stride = 0;
};

/// Keeps each role but `none` for the first field that has it; later ones become `none`. Returns which of x,
/// y and z no field has, or "".
std::string missing_coordinate(std::vector<Role>& roles);
/// The same; throws InputError if x, y or z is missing.
void check_roles(std::vector<Role>& roles, const std::string& file, const std::string& place);

/// Takes the points of a file one by one.
class PointSink {
 public:
  virtual ~PointSink() = default;
  /// Once, before the first point: what each point has, in any order, roles as checked. Text holds all digits
  /// of a number: its fields are never of type float32.
  virtual void begin(std::span<const Field> fields) = 0;
  virtual void set(Role role, double value) = 0;
  virtual void end_point() = 0;
};

/// Collects the points of a scan; drops those that are not finite.
class ScanBuilder final : public PointSink {
 public:
  void begin(std::span<const Field> fields) override;
  void set(Role role, double value) override;
  void end_point() override;
  Scan take() { return std::move(scan_); }

 private:
  Scan scan_;
  ScanPoint point_;
  bool finite_ = true;
};

/// The number stored at an address, its bytes in that order.
double value_at(const char* at, ValueType type, std::endian order);

/// Decodes `count` records; the caller has made sure that all of them lie within `bytes`.
void decode(std::span<const char> bytes, std::size_t count, const std::vector<Field>& fields,
            std::endian order, PointSink& sink);

/// The fields of a text file, of which only role and type count.
std::vector<Field> text_fields(std::span<const Role> roles, std::span<const ValueType> types);

}  // namespace karst::replay
