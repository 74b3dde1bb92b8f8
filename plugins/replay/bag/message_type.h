// The structure of a message, from its definition in ROS's .msg text.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "plugins/replay/scan_files/fields.h"

namespace karst::replay {

enum class Dialect { ros1, ros2 };

struct MessageType;

/// One member of a message. Members of structures that are no arrays stand in the message itself, by their
/// path: "header.stamp.sec". ROS 1's time and duration are structures of sec and nanosec, as in ROS 2.
struct MessageField {
  enum class Kind { number, text, structure };
  enum class Arity { one, fixed, sequence };

  std::string path;
  Kind kind = Kind::number;
  Arity arity = Arity::one;
  std::size_t count = 1;                         // of an array of fixed size
  ValueType number = ValueType::uint8;           // for numbers; bool is uint8
  std::shared_ptr<const MessageType> structure;  // for arrays of structures
};

struct MessageType {
  std::string name;
  std::vector<MessageField> fields;  // in the order in which they are stored
};

/// `definition`: the type's members, then those of other types, each after a line of = and "MSG:
/// package/Name". Throws MalformedError, with the number of the line in its text, on what is no definition.
MessageType parse_message_type(const std::string& name, std::string_view definition, Dialect dialect);

/// The definition of one of the types that karst uses, for bags without definitions; "" if it is not known.
std::string known_definition(std::string_view name, Dialect dialect);

}  // namespace karst::replay
