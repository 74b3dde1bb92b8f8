// PCD v0.7 (pointclouds.org): a header of text lines, then the points.
#include <cstring>
#include <limits>

#include "core_stack/common/error.h"
#include "plugins/replay/scan_files/lzf.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "plugins/replay/scan_files/text_numbers.h"

namespace karst::replay {
namespace {

using core::InputError;

struct PcdHeader {
  std::vector<Role> roles;       // one for each field
  std::vector<ValueType> types;  // one for each field
  std::vector<std::size_t> counts;
  std::size_t points = 0, data_at = 0, line = 0;
  std::string data;
};

std::vector<std::string> words_of(std::string_view rest) {
  std::vector<std::string> words;
  for (std::string_view w = next_word(rest); !w.empty(); w = next_word(rest)) words.emplace_back(w);
  return words;
}

std::size_t whole(const std::string& path, const std::string& place, const std::string& key,
                  const std::string& word) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    throw InputError(path, place, key + ": expected a whole number, got \"" + word + "\"");
  return value;
}

ValueType type_of(const std::string& path, const std::string& place, const std::string& kind,
                  std::size_t size) {
  const std::string prefix = kind == "F" ? "float" : kind == "I" ? "int" : kind == "U" ? "uint" : "";
  const auto type = type_named(prefix + std::to_string(8 * size));
  if (prefix.empty() || !type)
    throw InputError(path, place, "TYPE " + kind + " of SIZE " + std::to_string(size) + " is not known");
  return *type;
}

PcdHeader read_header(const std::string& path, std::string_view bytes, const FieldNames& names) {
  PcdHeader header;
  TextReader reader(bytes);
  std::vector<std::string> fields, kinds;
  std::vector<std::size_t> sizes;
  std::size_t width = 0, height = 1;
  bool has_points = false;
  std::string place;
  for (std::string_view text; reader.line(text);) {
    place = "line " + std::to_string(reader.number());
    if (reader.number() > 100 || text.size() > 100000) break;  // no header
    std::vector<std::string> words = words_of(text);
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::string key = words[0];
    words.erase(words.begin());
    const auto number = [&](std::size_t i) {
      return whole(path, place, key, i < words.size() ? words[i] : "");
    };
    if (key == "FIELDS" || key == "COLUMNS") fields = words;
    if (key == "TYPE") kinds = words;
    if (key == "SIZE")
      for (std::size_t i = 0; i < words.size(); ++i) sizes.push_back(number(i));
    if (key == "COUNT")
      for (std::size_t i = 0; i < words.size(); ++i) header.counts.push_back(number(i));
    if (key == "WIDTH") width = number(0);
    if (key == "HEIGHT") height = number(0);
    if (key == "POINTS") {
      header.points = number(0);
      has_points = true;
    }
    if (key != "DATA") continue;
    header.data = words.empty() ? "" : words[0];
    header.data_at = reader.position();
    header.line = reader.number();
    break;
  }
  if (header.data.empty()) throw InputError(path, "header", "is no PCD file: it has no line DATA");
  if (header.counts.empty()) header.counts.assign(fields.size(), 1);
  if (fields.empty() || sizes.size() != fields.size() || kinds.size() != fields.size() ||
      header.counts.size() != fields.size())
    throw InputError(path, "header", "FIELDS, SIZE, TYPE and COUNT must have as many entries each");
  constexpr std::size_t kMax = std::numeric_limits<std::size_t>::max();
  if (!has_points) {
    if (height != 0 && width > kMax / height) throw InputError(path, "header", "WIDTH x HEIGHT is too large");
    header.points = width * height;
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (header.counts[i] > 100000) throw InputError(path, "header", "COUNT is too large");
    header.types.push_back(type_of(path, "header", kinds[i], sizes[i]));
    header.roles.push_back(role_of(fields[i], names));
  }
  check_roles(header.roles, path, "header");
  return header;
}

/// Throws unless `points` records of `record` bytes fit into `have`.
void check_size(const std::string& path, const PcdHeader& h, std::size_t record, std::size_t have) {
  if (record == 0 || h.points > have / record)
    throw InputError(path, "byte " + std::to_string(h.data_at + have),
                     "the file is truncated: its header declares " + std::to_string(h.points) +
                         " points of " + std::to_string(record) + " bytes, of which " +
                         std::to_string(record == 0 ? 0 : have / record) + " are there");
}

std::size_t record_size(const PcdHeader& h) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < h.types.size(); ++i) size += size_of(h.types[i]) * h.counts[i];
  return size;
}

void read_binary(const std::string& path, const PcdHeader& h, std::string_view data, PointSink& sink) {
  const std::size_t record = record_size(h);
  check_size(path, h, record, data.size());
  std::vector<Field> fields;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < h.types.size(); ++i) {
    fields.push_back({h.roles[i], h.types[i], offset, record});
    offset += size_of(h.types[i]) * h.counts[i];
  }
  decode(data, h.points, fields, std::endian::little, sink);
}

/// Two sizes, then LZF-compressed data: all values of the first field, all of the second, and so on.
void read_compressed(const std::string& path, const PcdHeader& h, std::string_view data, PointSink& sink) {
  const std::string place = "byte " + std::to_string(h.data_at);
  std::uint32_t packed = 0, unpacked = 0;
  if (data.size() < 8)
    throw InputError(path, place, "the file is truncated: the sizes of its data are missing");
  std::memcpy(&packed, data.data(), 4);
  std::memcpy(&unpacked, data.data() + 4, 4);
  if (packed > data.size() - 8)
    throw InputError(path, "byte " + std::to_string(h.data_at + data.size()),
                     "the file is truncated: it declares " + std::to_string(packed) +
                         " bytes of compressed data and has " + std::to_string(data.size() - 8));
  const std::size_t record = record_size(h);
  if (record == 0 || h.points != unpacked / record || unpacked % record != 0)
    throw InputError(path, place,
                     "its header declares " + std::to_string(h.points) + " points of " +
                         std::to_string(record) + " bytes, its data " + std::to_string(unpacked) + " bytes");
  // LZF expands 3 bytes to at most 264: a larger claim means damage, so no memory is allocated for it.
  std::optional<std::string> bytes;
  if (unpacked / 88 <= packed) bytes = lzf_decompress(data.substr(8, packed), unpacked);
  if (!bytes) throw InputError(path, place, "its compressed data is damaged");
  std::vector<Field> fields;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < h.types.size(); ++i) {
    const std::size_t stride = size_of(h.types[i]) * h.counts[i];
    fields.push_back({h.roles[i], h.types[i], offset, stride});
    offset += stride * h.points;
  }
  decode(*bytes, h.points, fields, std::endian::little, sink);
}

void read_ascii(const std::string& path, const PcdHeader& h, std::string_view data, PointSink& sink) {
  sink.begin(text_fields(h.roles, h.types));
  TextReader reader(data, h.line + 1);
  std::size_t count = 0;
  for (std::string_view text; count < h.points && reader.line(text);) {
    if (text.find_first_not_of(" \t") == std::string_view::npos) continue;
    for (std::size_t i = 0; i < h.types.size(); ++i)
      for (std::size_t k = 0; k < h.counts[i]; ++k) {
        double value = 0;
        if (!to_number(next_word(text), value))
          throw InputError(path, "line " + std::to_string(reader.number()),
                           "is not the numbers that its header's fields ask for");
        if (k == 0) sink.set(h.roles[i], value);
      }
    sink.end_point();
    ++count;
  }
  if (count < h.points)
    throw InputError(path, "line " + std::to_string(reader.number()),
                     "the file is truncated: its header declares " + std::to_string(h.points) +
                         " points, it has " + std::to_string(count));
}

}  // namespace

void read_pcd(const std::string& path, const FieldNames& names, PointSink& sink) {
  const std::string bytes = file_bytes(path);
  const PcdHeader header = read_header(path, bytes, names);
  const std::string_view data = std::string_view(bytes).substr(header.data_at);
  if (header.data == "binary") return read_binary(path, header, data, sink);
  if (header.data == "binary_compressed") return read_compressed(path, header, data, sink);
  if (header.data == "ascii") return read_ascii(path, header, data, sink);
  throw InputError(path, "line " + std::to_string(header.line),
                   "DATA must be ascii, binary or binary_compressed, got \"" + header.data + "\"");
}

}  // namespace karst::replay
