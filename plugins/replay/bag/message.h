// A message decoded by its type: a view of its bytes.
#pragma once
#include "plugins/replay/bag/bytes.h"
#include "plugins/replay/bag/message_type.h"

namespace karst::replay {

/// How values follow each other. ROS 1: little-endian, without gaps. CDR: each number at a multiple of its
/// size.
struct WireFormat {
  std::endian order = std::endian::little;
  bool aligned = false;
};

/// Takes what is stored by a WireFormat. Alignment counts from the first byte.
class WireReader {
 public:
  WireReader(Bytes bytes, WireFormat format, std::size_t at = 0) : bytes_(bytes), format_(format), at_(at) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  Bytes bytes() const { return bytes_; }
  WireFormat format() const { return format_; }

  /// The bytes of `count` numbers that follow each other.
  Bytes take_numbers(ValueType type, std::size_t count);
  std::uint32_t take_length();
  std::string_view take_text();

 private:
  Bytes bytes_;
  WireFormat format_;
  std::size_t at_;
};

class Message {
 public:
  /// Reads the members of `type` from `reader`. `type` and the bytes must outlive the message. Throws
  /// MalformedError, `at` counted from the reader's first byte.
  Message(const MessageType& type, WireReader& reader);
  /// A whole message as a bag stores it; with ROS 2, its bytes begin with those that tell the order of bytes.
  static Message of(const MessageType& type, Bytes stored, Dialect dialect);

  /// These throw MalformedError if the type has no such member, or one of another kind.
  double number(std::string_view path) const;
  std::int64_t whole(std::string_view path) const;
  std::string_view text(std::string_view path) const;
  /// The bytes of an array of numbers of this type.
  Bytes numbers(std::string_view path, ValueType type) const;
  std::vector<Message> structures(std::string_view path) const;

  /// An array of structures that consist of single numbers, all of them laid out alike.
  struct Records {
    Bytes bytes;
    std::size_t count = 0, stride = 0;
    std::vector<std::pair<std::string, Field>> fields;  // name; type, offset and stride
  };
  Records records(std::string_view path) const;

  std::endian order() const { return format_.order; }

 private:
  struct Value {
    Bytes bytes;            // of numbers and text; of structures from the first to the end of the last
    std::size_t count = 1;  // of an array
    std::size_t begin = 0;  // of an array of structures: in the message
  };
  const Value& find(std::string_view path, MessageField::Kind kind, bool array) const;

  const MessageType* type_;
  Bytes all_;
  WireFormat format_;
  std::vector<Value> values_;  // one a field of the type
};

}  // namespace karst::replay
