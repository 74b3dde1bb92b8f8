#include "plugins/replay/bag/message.h"

#include <algorithm>

namespace karst::replay {
namespace {

/// Where the members of a structure lie, if that is the same for each element of an array of it.
struct StructureLayout {
  std::vector<std::size_t> offsets;
  std::size_t stride = 0;
};

/// nullopt if the structure has arrays or texts, or gaps that depend on where it stands: with CDR they do
/// unless the first member has the greatest alignment.
std::optional<StructureLayout> layout_of_structure(const MessageType& type, bool aligned) {
  if (type.fields.empty()) return std::nullopt;
  StructureLayout layout;
  std::size_t end = 0;
  const std::size_t first = size_of(type.fields.front().number);
  for (const MessageField& f : type.fields) {
    if (f.kind != MessageField::Kind::number || f.arity != MessageField::Arity::one) return std::nullopt;
    const std::size_t size = size_of(f.number);
    if (aligned && size > first) return std::nullopt;
    if (aligned) end = (end + size - 1) / size * size;
    layout.offsets.push_back(end);
    end += size;
  }
  layout.stride = aligned ? (end + first - 1) / first * first : end;
  return layout;
}

}  // namespace

Bytes WireReader::take_numbers(ValueType type, std::size_t count) {
  const std::size_t size = size_of(type);
  if (format_.aligned && count > 0) at_ = std::min((at_ + size - 1) / size * size, bytes_.size());
  if (count > left() / size)
    throw MalformedError("ends within a value: " + std::to_string(count) + " numbers of " +
                             std::to_string(size) + " bytes are announced, " + std::to_string(left()) +
                             " bytes are left",
                         at_);
  const Bytes part = bytes_.subspan(at_, count * size);
  at_ += part.size();
  return part;
}

std::uint32_t WireReader::take_length() {
  return static_cast<std::uint32_t>(
      value_at(take_numbers(ValueType::uint32, 1).data(), ValueType::uint32, format_.order));
}

std::string_view WireReader::take_text() {
  const Bytes bytes = take_numbers(ValueType::uint8, take_length());
  std::string_view text(bytes.data(), bytes.size());
  if (format_.aligned && text.ends_with('\0')) text.remove_suffix(1);  // CDR counts the zero at the end
  return text;
}

Message::Message(const MessageType& type, WireReader& reader)
    : type_(&type), all_(reader.bytes()), format_(reader.format()) {
  values_.reserve(type.fields.size());
  for (const MessageField& f : type.fields) {
    Value v;
    v.count = f.arity == MessageField::Arity::sequence ? reader.take_length() : f.count;
    switch (f.kind) {
      case MessageField::Kind::number:
        v.bytes = reader.take_numbers(f.number, v.count);
        break;
      case MessageField::Kind::text: {
        std::string_view text;
        for (std::size_t i = 0; i < v.count; ++i) text = reader.take_text();
        v.bytes = Bytes(text.data(), text.size());
        break;
      }
      case MessageField::Kind::structure: {
        v.begin = reader.at();
        const auto layout = layout_of_structure(*f.structure, format_.aligned);
        if (v.count > reader.left())
          throw MalformedError("ends within an array of " + std::to_string(v.count) + " " + f.structure->name,
                               reader.at());
        if (layout && v.count > 0) {
          // All but the last with the gap after it.
          const Bytes first = reader.take_numbers(f.structure->fields.front().number, 1);
          v.begin = static_cast<std::size_t>(first.data() - all_.data());
          const std::size_t last = layout->offsets.back() + size_of(f.structure->fields.back().number);
          reader.take_numbers(ValueType::uint8, (v.count - 1) * layout->stride + last - first.size());
        } else {
          for (std::size_t i = 0; i < v.count; ++i) {
            const std::size_t before = reader.at();
            Message(*f.structure, reader);
            if (reader.at() == before) break;  // it has no bytes, and so have the others
          }
        }
        v.bytes = all_.subspan(v.begin, reader.at() - v.begin);
        break;
      }
    }
    values_.push_back(v);
  }
}

Message Message::of(const MessageType& type, Bytes stored, Dialect dialect) {
  if (dialect == Dialect::ros1) {
    WireReader reader(stored, {});
    return {type, reader};
  }
  // CDR begins with two bytes that name the encoding, and two of options.
  if (stored.size() < 4 || stored[0] != 0 || (stored[1] != 0 && stored[1] != 1))
    throw MalformedError("is no CDR: it begins with none of the bytes 0 0 and 0 1", 0);
  const std::endian order = stored[1] == 0 ? std::endian::big : std::endian::little;
  WireReader reader(stored.subspan(4), {order, true});
  return {type, reader};
}

const Message::Value& Message::find(std::string_view path, MessageField::Kind kind, bool array) const {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const MessageField& f = type_->fields[i];
    if (f.path != path) continue;
    if (f.kind != kind || (f.arity != MessageField::Arity::one) != array)
      throw MalformedError("the member " + std::string(path) + " of " + type_->name + " is of another type",
                           0);
    return values_[i];
  }
  throw MalformedError("the type " + type_->name + " has no member " + std::string(path), 0);
}

double Message::number(std::string_view path) const {
  const Value& v = find(path, MessageField::Kind::number, false);
  return value_at(v.bytes.data(), type_->fields[static_cast<std::size_t>(&v - values_.data())].number,
                  format_.order);
}

std::int64_t Message::whole(std::string_view path) const {
  const Value& v = find(path, MessageField::Kind::number, false);
  const ValueType type = type_->fields[static_cast<std::size_t>(&v - values_.data())].number;
  if (!is_whole(type)) throw MalformedError("the member " + std::string(path) + " is no integer", 0);
  const std::size_t n = size_of(type);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = format_.order == std::endian::little ? n - 1 - i : i;
    bits = bits << 8 | static_cast<unsigned char>(v.bytes[at]);
  }
  const bool is_signed = type == ValueType::int8 || type == ValueType::int16 || type == ValueType::int32;
  if (is_signed && (bits >> (8 * n - 1)) != 0) bits |= ~std::uint64_t{0} << (8 * n);
  return static_cast<std::int64_t>(bits);
}

std::string_view Message::text(std::string_view path) const {
  const Bytes b = find(path, MessageField::Kind::text, false).bytes;
  return {b.data(), b.size()};
}

Bytes Message::numbers(std::string_view path, ValueType type) const {
  const Value& v = find(path, MessageField::Kind::number, true);
  if (type_->fields[static_cast<std::size_t>(&v - values_.data())].number != type)
    throw MalformedError("the member " + std::string(path) + " of " + type_->name + " is of another type", 0);
  return v.bytes;
}

std::vector<Message> Message::structures(std::string_view path) const {
  const Value& v = find(path, MessageField::Kind::structure, true);
  const MessageType& element = *type_->fields[static_cast<std::size_t>(&v - values_.data())].structure;
  WireReader reader(all_, format_, v.begin);
  std::vector<Message> list;
  for (std::size_t i = 0; i < v.count; ++i) list.emplace_back(element, reader);
  return list;
}

Message::Records Message::records(std::string_view path) const {
  const Value& v = find(path, MessageField::Kind::structure, true);
  const MessageType& element = *type_->fields[static_cast<std::size_t>(&v - values_.data())].structure;
  const auto layout = layout_of_structure(element, format_.aligned);
  if (!layout) throw MalformedError("the elements of " + std::string(path) + " are not laid out alike", 0);
  Records records{v.bytes, v.count, layout->stride, {}};
  for (std::size_t i = 0; i < element.fields.size(); ++i)
    records.fields.emplace_back(element.fields[i].path, Field{Role::none, element.fields[i].number,
                                                              layout->offsets[i], layout->stride});
  return records;
}

}  // namespace karst::replay
