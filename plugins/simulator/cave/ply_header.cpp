#include "plugins/simulator/cave/ply_header.h"

#include <sstream>
#include <utility>

namespace karst::cave {

using core::InputError;

namespace {

std::size_t ply_size(const std::string& path, const std::string& type) {
  for (const auto& [names, bytes] : {std::pair{" char uchar int8 uint8 ", 1},
                                     {" short ushort int16 uint16 ", 2},
                                     {" int uint float int32 uint32 float32 ", 4},
                                     {" double float64 ", 8}})
    if (std::string(names).find(" " + type + " ") != std::string::npos)
      return static_cast<std::size_t>(bytes);
  throw InputError(path, "header", "unknown property type \"" + type + "\"");
}

}  // namespace

PlyHeader read_ply_header(const std::string& path, std::istream& in) {
  PlyHeader header;
  std::string line;
  if (!std::getline(in, line) || line.substr(0, 3) != "ply")
    throw InputError(path, "line 1", "expected \"ply\"");
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "end_header") return header;
    if (word == "format") words >> header.format;
    if (word == "element") {
      PlyElement& e = header.elements.emplace_back();
      words >> e.name >> e.count;
    }
    if (word == "property" && !header.elements.empty()) {
      PlyProperty p;
      words >> p.type;
      if (p.type == "list") {
        words >> p.type;
        p.count_size = ply_size(path, p.type);
        words >> p.type;
      }
      p.size = ply_size(path, p.type);
      words >> p.name;
      header.elements.back().properties.push_back(std::move(p));
    }
  }
  throw InputError(path, "header", "the file is truncated: no \"end_header\"");
}

std::uintmax_t list_length(const std::string& bytes, std::size_t at, std::size_t size, bool big_endian) {
  std::uintmax_t n = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[at + (big_endian ? i : size - 1 - i)]);
    n = (n << 8) | byte;
  }
  return n;
}

}  // namespace karst::cave
