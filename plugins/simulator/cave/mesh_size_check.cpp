#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "plugins/simulator/cave/ply_header.h"
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

void check_ply(const std::string& path, std::ifstream& in, std::uintmax_t size) {
  const PlyHeader header = read_ply_header(path, in);
  const auto header_size = static_cast<std::uintmax_t>(in.tellg());
  std::string body(static_cast<std::size_t>(size - std::min(size, header_size)), '\0');
  in.read(body.data(), static_cast<std::streamsize>(body.size()));
  body.resize(static_cast<std::size_t>(in.gcount()));
  if (header.format != "ascii")
    return walk_binary_ply(path, header, body, header_size,
                           [](const PlyElement&, std::size_t, std::size_t) {});
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
  if (extension == ".ply") check_ply(path, in, size);
}

}  // namespace karst::cave
