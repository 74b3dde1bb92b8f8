// Enumerations by name. One that stands in files, in options or on the screen has one table, beside it, that
// names each of its values:
//
//   enum class Exposure { automatic, fixed };
//   constexpr auto names_of(Exposure) {
//     using enum Exposure;
//     return std::to_array<Named<Exposure>>({{automatic, "auto"}, {fixed, "fixed"}});
//   }
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace karst::core {

template <class E>
struct Named {
  E value;
  const char* name;
};

/// An enumeration with a table of names, found by argument-dependent lookup.
template <class E>
concept NamedEnum = std::is_enum_v<E> && requires {
  names_of(E{});
};

/// "unknown" for what no value of the table is, such as a number off the radio.
template <NamedEnum E>
constexpr const char* name_of(E value) {
  for (const Named<E>& n : names_of(E{}))
    if (n.value == value) return n.name;
  return "unknown";
}

template <NamedEnum E>
constexpr std::optional<E> parse(std::string_view name) {
  for (const Named<E>& n : names_of(E{}))
    if (name == n.name) return n.value;
  return std::nullopt;
}

/// All names, in the table's order.
template <NamedEnum E>
std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const Named<E>& n : names_of(E{})) names.emplace_back(n.name);
  return names;
}

}  // namespace karst::core
