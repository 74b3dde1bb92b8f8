// PLY (G. Turk): a header of text lines, then the elements one after another; here the vertices only.
#include <bit>

#include "core_stack/common/error.h"
#include "plugins/replay/scan_files/scan_file.h"
#include "plugins/replay/scan_files/text_numbers.h"

namespace karst::replay {
namespace {

using core::InputError;

struct Element {
  std::string name;
  std::size_t count = 0;
  bool has_list = false;
  std::vector<std::string> names;
  std::vector<ValueType> types;
  std::size_t record() const {
    std::size_t size = 0;
    for (const ValueType t : types) size += size_of(t);
    return size;
  }
};

struct PlyHeader {
  std::string format;
  std::vector<Element> elements;
  std::size_t data_at = 0, line = 0;
};

PlyHeader read_header(const std::string& path, std::string_view bytes) {
  PlyHeader header;
  TextReader reader(bytes);
  std::string_view text;
  if (!reader.line(text) || text != "ply")
    throw InputError(path, "line 1", "is no PLY file: expected \"ply\"");
  while (reader.number() < 1000 && reader.line(text)) {
    const std::string place = "line " + std::to_string(reader.number());
    const std::string key(next_word(text));
    if (key == "end_header") {
      header.data_at = reader.position();
      header.line = reader.number();
      if (header.format.empty()) throw InputError(path, place, "the header names no format");
      return header;
    }
    if (key == "format") header.format = next_word(text);
    if (key == "element") {
      Element e;
      e.name = next_word(text);
      const std::string_view count = next_word(text);
      const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), e.count);
      if (error != std::errc() || end != count.data() + count.size())
        throw InputError(path, place, "element " + e.name + ": expected a number of elements");
      header.elements.push_back(std::move(e));
    }
    if (key != "property") continue;
    if (header.elements.empty()) throw InputError(path, place, "a property before the first element");
    Element& e = header.elements.back();
    const std::string type_name(next_word(text));
    if (type_name == "list") {
      e.has_list = true;
      continue;
    }
    const auto type = type_named(type_name);
    if (!type) throw InputError(path, place, "unknown type of property \"" + type_name + "\"");
    e.types.push_back(*type);
    e.names.emplace_back(next_word(text));
  }
  throw InputError(path, "line " + std::to_string(reader.number()), "the header does not end");
}

void read_ascii(const std::string& path, const PlyHeader& h, std::size_t skipped_lines, const Element& e,
                std::span<const Role> roles, std::string_view data, PointSink& sink) {
  sink.begin(text_fields(roles, e.types));
  TextReader reader(data, h.line + 1);
  std::string_view text;
  std::size_t skipped = 0;
  while (skipped < skipped_lines && reader.line(text)) ++skipped;
  for (std::size_t i = 0; i < e.count; ++i) {
    if (!reader.line(text))
      throw InputError(path, "line " + std::to_string(reader.number()),
                       "the file is truncated: its header declares " + std::to_string(e.count) +
                           " vertices, it has " + std::to_string(i));
    for (const Role role : roles) {
      double value = 0;
      if (!to_number(next_word(text), value))
        throw InputError(path, "line " + std::to_string(reader.number()),
                         "is not the numbers that its header's properties ask for");
      sink.set(role, value);
    }
    sink.end_point();
  }
}

}  // namespace

void read_ply(const std::string& path, const FieldNames& names, PointSink& sink) {
  const std::string bytes = file_bytes(path);
  const PlyHeader header = read_header(path, bytes);
  std::size_t skipped_bytes = 0, skipped_lines = 0;
  const Element* vertex = nullptr;
  for (const Element& e : header.elements) {
    if (e.name == "vertex") {
      vertex = &e;
      break;
    }
    if (e.has_list || (e.record() > 0 && e.count > bytes.size() / e.record()))
      throw InputError(path, "element " + e.name, "stands before the vertices and cannot be passed over");
    skipped_bytes += e.count * e.record();
    skipped_lines += e.count;
  }
  if (!vertex) throw InputError(path, "header", "has no element \"vertex\"");
  if (vertex->has_list) throw InputError(path, "element vertex", "lists in vertices are not supported");

  std::vector<Role> roles;
  for (const std::string& n : vertex->names) roles.push_back(role_of(n, names));
  check_roles(roles, path, "element vertex");
  std::vector<Field> fields;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    fields.push_back({roles[i], vertex->types[i], offset, vertex->record()});
    offset += size_of(vertex->types[i]);
  }
  const std::string_view data = std::string_view(bytes).substr(header.data_at);
  if (header.format == "ascii") return read_ascii(path, header, skipped_lines, *vertex, roles, data, sink);
  const bool little = header.format == "binary_little_endian";
  if (!little && header.format != "binary_big_endian")
    throw InputError(path, "header", "unknown format \"" + header.format + "\"");
  const std::size_t have = data.size() > skipped_bytes ? data.size() - skipped_bytes : 0;
  if (vertex->count > have / vertex->record())
    throw InputError(path, "byte " + std::to_string(bytes.size()),
                     "the file is truncated: its header declares " + std::to_string(vertex->count) +
                         " vertices of " + std::to_string(vertex->record()) + " bytes, of which " +
                         std::to_string(have / vertex->record()) + " are there");
  decode(data.substr(std::min(skipped_bytes, data.size())), vertex->count, fields,
         little ? std::endian::little : std::endian::big, sink);
}

std::size_t ply_faces(const std::string& path) {
  const std::string bytes = file_bytes(path);
  for (const Element& e : read_header(path, bytes).elements)
    if (e.name == "face") return e.count;
  return 0;
}

}  // namespace karst::replay
