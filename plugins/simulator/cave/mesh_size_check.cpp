#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {
namespace {

using core::InputError;

[[noreturn]] void truncated(const std::string& path, std::uintmax_t expected, std::uintmax_t actual) {
  throw InputError(path, "byte " + std::to_string(actual),
                   "the file is truncated: its header declares " + std::to_string(expected) +
                       " bytes, it has " + std::to_string(actual));
}

/// Binary STL: 80 bytes of title, the number of triangles, 50 bytes for each. Text STL ends in "endsolid".
void check_stl(const std::string& path, std::ifstream& in, std::uintmax_t size) {
  char head[84] = {};
  in.read(head, sizeof head);
  std::uint32_t count = 0;
  std::memcpy(&count, head + 80, sizeof count);
  const std::uintmax_t expected = 84 + std::uintmax_t{50} * count;
  if (size >= 84 && size == expected) return;
  if (std::string(head, 5) != "solid") {
    if (size < 84) throw InputError(path, "", "the file is truncated: a binary STL has at least 84 bytes");
    if (size < expected) truncated(path, expected, size);
    return;
  }
  in.clear();
  in.seekg(-static_cast<std::streamoff>(std::min<std::uintmax_t>(size, 512)), std::ios::end);
  const std::string tail(std::istreambuf_iterator<char>(in), {});
  if (tail.find("endsolid") == std::string::npos)
    throw InputError(path, "", "the file is truncated: a text STL ends with \"endsolid\"");
}

struct PlyProperty {
  std::size_t size = 0, count_size = 0;  // count_size > 0: a list
};
struct PlyElement {
  std::string name;
  std::uintmax_t count = 0;
  std::vector<PlyProperty> properties;
};

std::size_t ply_size(const std::string& path, const std::string& type) {
  for (const auto& [names, bytes] : {std::pair{" char uchar int8 uint8 ", 1},
                                     {" short ushort int16 uint16 ", 2},
                                     {" int uint float int32 uint32 float32 ", 4},
                                     {" double float64 ", 8}})
    if (std::string(names).find(" " + type + " ") != std::string::npos)
      return static_cast<std::size_t>(bytes);
  throw InputError(path, "header", "unknown property type \"" + type + "\"");
}

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
};

PlyHeader read_ply_header(const std::string& path, std::istream& in) {
  PlyHeader header;
  std::string line;
  if (!std::getline(in, line) || line.substr(0, 3) != "ply")
    throw InputError(path, "line 1", "expected \"ply\"");
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word;
    if (word == "end_header") return header;
    if (word == "format") words >> header.format;
    if (word == "element") {
      PlyElement& e = header.elements.emplace_back();
      words >> e.name >> e.count;
    }
    if (word == "property" && !header.elements.empty()) {
      words >> type;
      PlyProperty p;
      if (type == "list") {
        words >> type;
        p.count_size = ply_size(path, type);
        words >> type;
      }
      p.size = ply_size(path, type);
      header.elements.back().properties.push_back(p);
    }
  }
  throw InputError(path, "header", "the file is truncated: no \"end_header\"");
}

/// Length of a list, in the file's byte order.
std::uintmax_t list_length(const std::string& bytes, std::size_t at, std::size_t size, bool big_endian) {
  std::uintmax_t n = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[at + (big_endian ? i : size - 1 - i)]);
    n = (n << 8) | byte;
  }
  return n;
}

void check_binary_ply(const std::string& path, const PlyHeader& header, const std::string& body,
                      std::uintmax_t header_size) {
  const bool big_endian = header.format == "binary_big_endian";
  std::uintmax_t at = 0;
  const auto take = [&](const PlyElement& e, std::uintmax_t index, std::uintmax_t bytes) {
    if (bytes > body.size() - at)
      throw InputError(path, "byte " + std::to_string(header_size + body.size()),
                       "the file is truncated in " + e.name + " " + std::to_string(index) + " of " +
                           std::to_string(e.count));
    at += bytes;
  };
  for (const PlyElement& e : header.elements) {
    if (e.properties.empty() && e.count > 0)  // would take no bytes, however many there are
      throw InputError(path, "element " + e.name, "has no properties");
    for (std::uintmax_t i = 0; i < e.count; ++i)
      for (const PlyProperty& p : e.properties) {
        if (p.count_size == 0) {
          take(e, i, p.size);
          continue;
        }
        const std::uintmax_t count_at = at;
        take(e, i, p.count_size);
        const std::uintmax_t items =
            list_length(body, static_cast<std::size_t>(count_at), p.count_size, big_endian);
        take(e, i, p.size * std::min<std::uintmax_t>(items, body.size() + 1));
      }
  }
}

void check_ply(const std::string& path, std::ifstream& in) {
  const PlyHeader header = read_ply_header(path, in);
  const auto header_size = static_cast<std::uintmax_t>(in.tellg());
  const std::string body(std::istreambuf_iterator<char>(in), {});
  if (header.format != "ascii") return check_binary_ply(path, header, body, header_size);
  std::uintmax_t expected = 0, lines = 0;
  for (const PlyElement& e : header.elements) expected += e.count;
  for (std::size_t begin = 0; begin < body.size();) {
    const std::size_t end = std::min(body.find('\n', begin), body.size());
    lines +=
        std::string_view(body).substr(begin, end - begin).find_first_not_of(" \t\r") != std::string::npos;
    begin = end + 1;
  }
  if (lines < expected)
    throw InputError(path, "",
                     "the file is truncated: its header declares " + std::to_string(expected) +
                         " lines of data, it has " + std::to_string(lines));
}

}  // namespace

void check_declared_size(const std::string& path) {
  std::ifstream in = core::open_input(path, core::kMaxMeshFileBytes);
  const std::uintmax_t size = std::filesystem::file_size(path);
  if (size == 0) throw InputError(path, "", "the file is empty");
  const std::string extension = lower_extension(path);
  if (extension == ".stl") check_stl(path, in, size);
  if (extension == ".ply") check_ply(path, in);
}

}  // namespace karst::cave
