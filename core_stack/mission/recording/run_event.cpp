#include "core_stack/mission/recording/run_event.h"

#include <concepts>
#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/common/json_point.h"
#include "core_stack/common/json_text.h"

namespace karst::core::event {
namespace {

using nlohmann::json;

/// What was expected in a field.
struct Expected {
  std::string what;
};

json written(const NamedEnum auto& v) { return name_of(v); }
json written(const Vec3& p) { return list(p); }
json written(const std::vector<Vec3>& points) { return list(points); }
json written(const std::vector<Cluster>& clusters) {
  json all = json::array();
  for (const Cluster& c : clusters)
    all.push_back({c.id, c.centroid.x(), c.centroid.y(), c.centroid.z(), c.unknown_cells});
  return all;
}
template <class T>
requires std::integral<T> || std::same_as<T, double> || std::same_as<T, std::string> json
written(const T& v) {
  return v;
}

void take(const json& j, bool& v) {
  if (!j.is_boolean()) throw Expected{"true or false"};
  v = j;
}
void take(const json& j, double& v) {
  if (!j.is_number() && !j.is_null()) throw Expected{"a number or null"};
  v = j.is_null() ? kUnknown : j.get<double>();
}
template <std::integral Integer>
void take(const json& j, Integer& v) {
  const bool in_range = j.is_number_unsigned()
                            ? std::in_range<Integer>(j.get<std::uint64_t>())
                            : j.is_number_integer() && std::in_range<Integer>(j.get<std::int64_t>());
  if (!in_range) throw Expected{"a whole number that fits"};
  v = j.get<Integer>();
}
void take(const json& j, std::string& v) {
  if (!j.is_string()) throw Expected{"text"};
  v = j;
}
template <NamedEnum E>
void take(const json& j, E& v) {
  const auto parsed = j.is_string() ? parse<E>(j.get_ref<const std::string&>()) : std::nullopt;
  if (!parsed) {
    std::string names;
    for (const std::string& n : all_names<E>()) names += (names.empty() ? "" : ", ") + n;
    throw Expected{"one of " + names};
  }
  v = *parsed;
}
void take(const json& j, Vec3& p) {
  if (!j.is_array() || j.size() != 3) throw Expected{"a point [x, y, z]"};
  for (std::size_t i = 0; i < 3; ++i) take(j[i], p[static_cast<Eigen::Index>(i)]);
}
void take(const json& j, Cluster& c) {
  if (!j.is_array() || j.size() != 5) throw Expected{"clusters [id, x, y, z, cells]"};
  take(j[0], c.id);
  take(json{j[1], j[2], j[3]}, c.centroid);
  take(j[4], c.unknown_cells);
}
template <class T>
void take(const json& j, std::vector<T>& all) {
  if (!j.is_array()) throw Expected{"a list"};
  for (const json& one : j) take(one, all.emplace_back());
}
template <class T>
void take(const json& j, std::optional<T>& v) {
  take(j, v.emplace());
}

template <class T>
void put(json& fields, const char* name, const T& v) {
  fields[name] = written(v);
}
template <class T>
void put(json& fields, const char* name, const std::optional<T>& v) {
  if (v) put(fields, name, *v);
}

template <class T>
void take_field(const json& line, const char* kind, const char* name, T& v) {
  const auto found = line.find(name);
  try {
    if (found != line.end())
      take(*found, v);
    else if constexpr (NamedEnum<T>)
      throw Expected{"that it is there"};
  } catch (const Expected& e) {
    throw Malformed(std::string(kind) + ": " + name + ": expected " + e.what);
  }
}

json fields_of(const Event& event) {
  json fields = json::object();
  std::visit(
      [&fields]<class E>(const E& e) {
        std::apply([&](const auto&... f) { (put(fields, f.name, e.*f.member), ...); }, E::fields());
      },
      event);
  return fields;
}

/// Tries one kind after another.
template <std::size_t I = 0>
std::optional<Event> read_as(const json& line) {
  if constexpr (I < std::variant_size_v<Event>) {
    using E = std::variant_alternative_t<I, Event>;
    if (!is_kind(line, E::kKind)) return read_as<I + 1>(line);
    E e;
    std::apply([&](const auto&... f) { (take_field(line, E::kKind, f.name, e.*f.member), ...); },
               E::fields());
    return e;
  }
  return std::nullopt;
}

}  // namespace

std::string fields_text(const Event& event) { return json_text(fields_of(event)); }

std::string line_of(TimeNs t, const char* kind, const std::string& fields) {
  std::string line = json_text(nlohmann::ordered_json{{"t", seconds(t)}, {"kind", kind}});
  line.back() = ',';
  return line + fields.substr(1);
}

std::string line_of(TimeNs t, const Event& event) {
  const char* kind = std::visit([]<class E>(const E&) { return E::kKind; }, event);
  return line_of(t, kind, fields_text(event));
}

bool is_kind(const json& line, const char* kind) {
  const auto found = line.find("kind");
  return found != line.end() && *found == kind;
}

std::optional<Event> read(const json& line) { return read_as(line); }

}  // namespace karst::core::event
