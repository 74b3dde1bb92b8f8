// The header of a PLY file, and a walk over its binary data.
#pragma once
#include <algorithm>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "core_stack/common/error.h"

namespace karst::cave {

struct PlyProperty {
  std::string name, type;                // for a list, the type of its items
  std::size_t size = 0, count_size = 0;  // bytes; count_size > 0: a list
};
struct PlyElement {
  std::string name;
  std::uintmax_t count = 0;
  std::vector<PlyProperty> properties;
};
struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
  bool is_text() const { return format == "ascii"; }
  bool is_big_endian() const { return format == "binary_big_endian"; }
};

/// Reads up to and including the line "end_header". Throws InputError naming `path`.
PlyHeader read_ply_header(const std::string& path, std::istream& in);

/// Length of a list, in the file's byte order.
std::uintmax_t list_length(const std::string& bytes, std::size_t at, std::size_t size, bool big_endian);

/// Calls visit(element, index of the property, its first byte in `body`) for each property of each element in
/// the file's order; for a list, with the byte of its first item. Throws InputError where the body is too
/// short.
template <class Visit>
void walk_binary_ply(const std::string& path, const PlyHeader& header, const std::string& body,
                     std::uintmax_t header_size, const Visit& visit) {
  std::uintmax_t at = 0;
  const auto take = [&](const PlyElement& e, std::uintmax_t index, std::uintmax_t bytes) {
    if (bytes > body.size() - at)
      throw core::InputError(path, "byte " + std::to_string(header_size + body.size()),
                             "the file is truncated in " + e.name + " " + std::to_string(index) + " of " +
                                 std::to_string(e.count));
    at += bytes;
  };
  for (const PlyElement& e : header.elements) {
    if (e.properties.empty() && e.count > 0)  // would take no bytes, however many there are
      throw core::InputError(path, "element " + e.name, "has no properties");
    for (std::uintmax_t i = 0; i < e.count; ++i)
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        const PlyProperty& p = e.properties[k];
        std::uintmax_t items = 1;
        if (p.count_size > 0) {
          const std::uintmax_t count_at = at;
          take(e, i, p.count_size);
          items = list_length(body, static_cast<std::size_t>(count_at), p.count_size, header.is_big_endian());
        }
        const std::uintmax_t first = at;
        take(e, i, p.size * std::min<std::uintmax_t>(items, body.size() + 1));
        visit(e, k, static_cast<std::size_t>(first));
      }
  }
}

}  // namespace karst::cave
