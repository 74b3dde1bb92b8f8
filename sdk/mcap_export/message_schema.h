// The definition of a message in ROS 2's own notation, with those of the messages inside it: the encoding
// "ros2msg" of MCAP (https://mcap.dev/spec/registry). Made of the same fields as the bytes, so that the two
// cannot differ.
#pragma once
#include <algorithm>

#include "sdk/mcap_export/cdr.h"

namespace karst::ros {

struct MessageSchema {
  std::string name;        // "nav_msgs/msg/Odometry"
  std::string definition;  // its fields, and behind lines of 80 "=" those of each message inside it
};

template <class T>
struct TypeName;
template <>
struct TypeName<bool> {
  static std::string name() { return "bool"; }
};
template <class T>
requires(std::is_integral_v<T>) struct TypeName<T> {
  static std::string name() { return (std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T)); }
};
template <class T>
requires(std::is_floating_point_v<T>) struct TypeName<T> {
  static std::string name() { return "float" + std::to_string(8 * sizeof(T)); }
};
template <>
struct TypeName<std::string> {
  static std::string name() { return "string"; }
};
template <class T, std::size_t N>
struct TypeName<std::array<T, N>> {
  static std::string name() { return TypeName<T>::name() + "[" + std::to_string(N) + "]"; }
};
template <class T>
struct TypeName<std::vector<T>> {
  static std::string name() { return TypeName<T>::name() + "[]"; }
};
template <Message M>
struct TypeName<M> {
  static std::string name() { return M::kType; }
};

/// What a sequence or an array holds; any other type itself.
template <class T>
struct Element {
  using type = T;
};
template <class T, std::size_t N>
struct Element<std::array<T, N>> {
  using type = T;
};
template <class T>
struct Element<std::vector<T>> {
  using type = T;
};

struct Definition {
  std::string type, fields;
};

/// Adds a message's definition and, behind it, those of the messages inside it that are not there yet.
template <Message M>
void define(std::vector<Definition>& known) {
  if (std::any_of(known.begin(), known.end(), [](const Definition& d) { return d.type == M::kType; })) return;
  const auto line = []<class T>(const Field<M, T>& field) {
    return TypeName<T>::name() + " " + field.name + "\n";
  };
  std::apply([&](const auto&... field) { known.push_back({M::kType, (line(field) + ...)}); }, M::members());
  const auto inside = [&]<class T>(const Field<M, T>&) {
    if constexpr (Message<typename Element<T>::type>) define<typename Element<T>::type>(known);
  };
  std::apply([&](const auto&... field) { (inside(field), ...); }, M::members());
}

template <Message M>
MessageSchema schema_of() {
  std::vector<Definition> known;
  define<M>(known);
  MessageSchema schema{M::kType, known.front().fields};
  schema.name.insert(schema.name.find('/'), "/msg");
  for (std::size_t i = 1; i < known.size(); ++i)
    schema.definition += std::string(80, '=') + "\nMSG: " + known[i].type + "\n" + known[i].fields;
  return schema;
}

}  // namespace karst::ros
