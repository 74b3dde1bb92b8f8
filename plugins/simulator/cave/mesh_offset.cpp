#include "plugins/simulator/cave/mesh_offset.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/input_file.h"
#include "plugins/simulator/cave/ply_header.h"
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {
namespace {

using core::InputError;

struct Shift {
  const std::string& path;
  const MeshFrame& frame;
};

constexpr std::string_view kBlanks = " \t\r";

/// The word of a line that follows `at`, which moves behind it; empty at the end.
std::string_view next_word(std::string_view line, std::size_t& at) {
  const std::size_t begin = std::min(line.find_first_not_of(kBlanks, at), line.size());
  at = std::min(line.find_first_of(kBlanks, begin), line.size());
  return line.substr(begin, at - begin);
}

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double v = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(v)) return std::nullopt;
  return v;
}

/// Reads three numbers that follow `at` and appends them, shifted, each after a blank.
void append_shifted(const Shift& shift, const std::string& place, std::string_view line, std::size_t& at,
                    std::string& out) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> v = number_of(next_word(line, at));
    if (!v)
      throw InputError(shift.path, place,
                       "expected a vertex of three finite numbers: the offset cannot be subtracted");
    std::array<char, 40> text;
    constexpr int kDigits = 9;  // as many as tell one float from the next
    char* const end = std::to_chars(text.data(), text.data() + text.size(), *v - shift.frame.offset[axis],
                                    std::chars_format::general, kDigits)
                          .ptr;
    out += ' ';
    out.append(text.data(), end);
  }
}

/// The text with each line replaced by what rewrite(line, its place, out) appends for it.
template <class Rewrite>
std::string with_lines(const Shift& shift, std::string_view text, const char* what, const Rewrite& rewrite) {
  std::string out;
  out.reserve(text.size());
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const std::string place = what + std::to_string(++number);
    if (const std::size_t r = line.find('\r'); r != std::string_view::npos && r + 1 < line.size())
      throw InputError(shift.path, place,
                       "lines end in a carriage return alone: the offset cannot be subtracted");
    rewrite(line, place, out);
    if (end < text.size()) out += '\n';
    begin = end + 1;
  }
  return out;
}

std::string shifted_obj(const Shift& shift, std::string_view text) {
  return with_lines(
      shift, text, "line ", [&shift](std::string_view line, const std::string& place, std::string& out) {
        if (!line.starts_with("v ") && !line.starts_with("v\t")) {
          out += line;
          return;
        }
        std::size_t at = 1;
        out += 'v';
        append_shifted(shift, place, line, at, out);
        std::size_t ahead = at;
        const std::string_view fourth = next_word(line, ahead);
        const bool is_weight = !fourth.empty() && next_word(line, ahead).empty();
        if (is_weight && number_of(fourth) != 1.0)
          throw InputError(shift.path, place,
                           "the vertex has a weight other than 1: the offset cannot be subtracted");
        out += line.substr(at);
      });
}

std::string shifted_text_stl(const Shift& shift, std::string_view text) {
  return with_lines(shift, text, "line ",
                    [&shift](std::string_view line, const std::string& place, std::string& out) {
                      std::size_t at = 0, copied = 0;
                      std::string_view word = next_word(line, at);
                      if (word == "solid" || word == "endsolid") at = line.size();  // names follow
                      for (; !word.empty(); word = next_word(line, at)) {
                        if (word != "vertex") continue;
                        out += line.substr(copied, at - copied);
                        append_shifted(shift, place, line, at, out);
                        copied = at;
                      }
                      out += line.substr(copied);
                    });
}

template <class T>
T number_at(const char* at, bool big_endian) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <class T>
void shift_number(const Shift& shift, char* at, int axis, bool big_endian) {
  const auto value = static_cast<double>(number_at<T>(at, big_endian));
  if (sizeof(T) == sizeof(float) && std::abs(value) * shift.frame.metres_per_unit > kFarthestVertex_m)
    throw InputError(shift.path, "",
                     core::format_text("holds its coordinates in single precision: at %.0f they are rounded "
                                       "to %.2g, and no offset brings that back; export it near its "
                                       "origin, or as OBJ",
                                       value, float_spacing(value)));
  const auto shifted = static_cast<T>(value - shift.frame.offset[axis]);
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &shifted, sizeof(T));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  std::memcpy(at, bytes.data(), sizeof(T));
}

std::string shifted_binary_stl(const Shift& shift, std::string bytes) {
  constexpr std::size_t kHead = 84, kRecord = 50, kNormal = 12, kNumbers = 9;
  for (std::size_t at = kHead; at + kRecord <= bytes.size(); at += kRecord)
    for (std::size_t i = 0; i < kNumbers; ++i)
      shift_number<float>(shift, bytes.data() + at + kNormal + 4 * i, static_cast<int>(i % 3), false);
  return bytes;
}

bool is_double(const PlyProperty& p) { return p.type == "double" || p.type == "float64"; }
bool is_float(const PlyProperty& p) { return p.type == "float" || p.type == "float32"; }

/// Index of the property x of a vertex, which y and z follow.
std::size_t index_of_x(const std::string& path, const PlyElement& vertex) {
  const std::vector<PlyProperty>& all = vertex.properties;
  for (std::size_t k = 0; k + 2 < all.size() && all[k].count_size == 0; ++k)
    if (all[k].name == "x" && all[k + 1].name == "y" && all[k + 2].name == "z" &&
        std::all_of(&all[k], &all[k] + 3,
                    [](const PlyProperty& p) { return p.count_size == 0 && (is_double(p) || is_float(p)); }))
      return k;
  throw InputError(path, "header",
                   "the offset can be subtracted from vertices whose x, y and z follow each other, as float "
                   "or double");
}

std::string shifted_text_ply(const Shift& shift, const PlyHeader& header, std::string_view body) {
  std::size_t element = 0;
  std::uintmax_t passed = 0;  // of the element's lines
  return with_lines(
      shift, body, "line of data ", [&](std::string_view line, const std::string& place, std::string& out) {
        std::size_t at = 0;
        if (next_word(line, at).empty()) return;  // an empty line holds no vertex
        while (element < header.elements.size() && passed == header.elements[element].count) {
          ++element;
          passed = 0;
        }
        const bool is_vertex = element < header.elements.size() && header.elements[element].name == "vertex";
        ++passed;
        if (!is_vertex) {
          out += line;
          return;
        }
        at = 0;
        const std::size_t before = index_of_x(shift.path, header.elements[element]);
        for (std::size_t k = 0; k < before; ++k) out.append(next_word(line, at)) += ' ';
        std::string shifted;
        append_shifted(shift, place, line, at, shifted);
        out += std::string_view(shifted).substr(1);
        out += line.substr(at);
      });
}

std::string shifted_binary_ply(const Shift& shift, const PlyHeader& header, const std::string& body,
                               std::uintmax_t header_size) {
  std::string out = body;
  const PlyElement* vertex = nullptr;
  std::size_t x = 0;
  walk_binary_ply(shift.path, header, body, header_size,
                  [&](const PlyElement& e, std::size_t property, std::size_t at) {
                    if (e.name != "vertex") return;
                    if (vertex != &e) {
                      vertex = &e;
                      x = index_of_x(shift.path, e);
                    }
                    if (property < x || property > x + 2) return;
                    const auto axis = static_cast<int>(property - x);
                    if (is_double(e.properties[property]))
                      shift_number<double>(shift, out.data() + at, axis, header.is_big_endian());
                    else
                      shift_number<float>(shift, out.data() + at, axis, header.is_big_endian());
                  });
  return out;
}

std::string shifted_ply(const Shift& shift, const std::string& bytes) {
  std::istringstream in(bytes);
  const PlyHeader header = read_ply_header(shift.path, in);
  const std::streamoff end = in.tellg();  // -1: nothing follows the header
  const std::size_t size = end < 0 ? bytes.size() : static_cast<std::size_t>(end);
  const std::string body = bytes.substr(size);
  return bytes.substr(0, size) + (header.is_text() ? shifted_text_ply(shift, header, body)
                                                   : shifted_binary_ply(shift, header, body, size));
}

/// As the check of the declared size tells them apart.
bool is_text_stl(const std::string& head, std::uintmax_t file_size) {
  if (!head.starts_with("solid")) return false;
  if (head.size() < 84) return true;
  return file_size != 84 + std::uintmax_t{50} * number_at<std::uint32_t>(head.data() + 80, false);
}

}  // namespace

double float_spacing(double value) {
  const float v = std::abs(static_cast<float>(value));
  return static_cast<double>(std::nextafter(v, std::numeric_limits<float>::infinity())) -
         static_cast<double>(v);
}

std::string bytes_less_offset(const std::string& path, const MeshFrame& frame) {
  const Shift shift{path, frame};
  std::string bytes = core::read_input(path, core::kMaxMeshFileBytes);
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return shifted_obj(shift, bytes);
  if (extension == ".ply") return shifted_ply(shift, bytes);
  return is_text_stl(bytes.substr(0, 84), bytes.size()) ? shifted_text_stl(shift, bytes)
                                                        : shifted_binary_stl(shift, std::move(bytes));
}

bool holds_double_precision(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return true;
  if (extension != ".ply" && extension != ".stl") return false;
  std::ifstream in = core::open_input(path, core::kMaxMeshFileBytes);
  if (extension == ".stl") {
    std::string head(84, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    return is_text_stl(head, std::filesystem::file_size(path));
  }
  const PlyHeader header = read_ply_header(path, in);
  if (header.is_text()) return true;
  const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                   [](const PlyElement& e) { return e.name == "vertex"; });
  return vertex != header.elements.end() &&
         std::any_of(vertex->properties.begin(), vertex->properties.end(),
                     [](const PlyProperty& p) { return p.name == "x" && is_double(p); });
}

}  // namespace karst::cave
