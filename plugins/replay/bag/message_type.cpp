#include "plugins/replay/bag/message_type.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "plugins/replay/bag/bag.h"
#include "plugins/replay/bag/bytes.h"
#include "plugins/replay/scan_files/text_numbers.h"

namespace karst::replay {
namespace {

constexpr std::size_t kMaxFields = 4096;  // of one message: definitions nest, and could double at each level
constexpr int kMaxDepth = 16;

struct Line {
  std::string_view type, name;
  std::size_t number = 0;
};
using Definitions = std::map<std::string, std::vector<Line>, std::less<>>;

[[noreturn]] void refuse(std::size_t line, const std::string& reason) {
  throw MalformedError("line " + std::to_string(line) + " of the definition: " + reason, 0);
}

bool is_constant(std::string_view after_name) {
  const auto first = after_name.find_first_not_of(" \t");
  return first != std::string_view::npos && after_name[first] == '=';
}

/// Members of each type of a definition.
Definitions split(const std::string& name, std::string_view text) {
  Definitions definitions;
  std::vector<Line>* members = &definitions[plain_type(name)];
  TextReader reader(text);
  bool between = false;
  for (std::string_view line; reader.line(line);) {
    if (line.starts_with("====")) {
      between = true;
      continue;
    }
    std::string_view rest = line.substr(0, line.find('#'));
    std::string_view type = next_word(rest);
    if (type.empty()) continue;
    if (between) {
      if (type != "MSG:") refuse(reader.number(), "expected \"MSG: package/Type\"");
      members = &definitions[plain_type(next_word(rest))];
      members->clear();
      between = false;
      continue;
    }
    const auto begin = rest.find_first_not_of(" \t");
    if (begin == std::string_view::npos) refuse(reader.number(), "a type without a name");
    rest.remove_prefix(begin);
    const auto end = std::min(rest.find_first_of(" \t="), rest.size());
    const std::string_view member = rest.substr(0, end);
    if (member.empty()) refuse(reader.number(), "a type without a name");
    if (!is_constant(rest.substr(end))) members->push_back({type, member, reader.number()});
  }
  return definitions;
}

std::optional<ValueType> number_named(std::string_view type, Dialect dialect) {
  if (type == "bool") return ValueType::uint8;
  if (type == "char") return ValueType::uint8;
  if (type == "byte") return dialect == Dialect::ros1 ? ValueType::int8 : ValueType::uint8;
  for (const char* name :
       {"int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64"})
    if (type == name) return type_named(name);
  return std::nullopt;
}

class Flattener {
 public:
  Flattener(const Definitions& definitions, Dialect dialect) : definitions_(definitions), dialect_(dialect) {}

  MessageType type(const std::string& name, int depth, std::size_t line) {
    MessageType result{name, {}};
    add_members(name, "", depth, line, result.fields);
    return result;
  }

 private:
  void add_members(const std::string& name, const std::string& prefix, int depth, std::size_t line,
                   std::vector<MessageField>& fields) {
    if (depth > kMaxDepth) refuse(line, "types are nested deeper than " + std::to_string(kMaxDepth));
    const auto found = definitions_.find(name);
    if (found == definitions_.end()) refuse(line, "the type " + name + " is not defined");
    const std::string package = name.substr(0, name.find('/'));
    for (const Line& l : found->second) add_member(l, package, prefix, depth, fields);
    if (found->second.empty() && dialect_ == Dialect::ros2) {  // IDL has no empty structures
      MessageField filler;
      filler.path = prefix + "structure_needs_at_least_one_member";
      add(std::move(filler), line, fields);
    }
  }

  void add_member(const Line& l, const std::string& package, const std::string& prefix, int depth,
                  std::vector<MessageField>& fields) {
    MessageField field;
    field.path = prefix + std::string(l.name);
    std::string_view type = l.type;
    if (const auto bracket = type.find('['); bracket != std::string_view::npos) {
      if (type.back() != ']') refuse(l.number, "an array without its end");
      const std::string_view size = type.substr(bracket + 1, type.size() - bracket - 2);
      type = type.substr(0, bracket);
      field.arity = MessageField::Arity::sequence;
      if (!size.empty() && !size.starts_with("<=")) {
        field.arity = MessageField::Arity::fixed;
        const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), field.count);
        if (error != std::errc() || end != size.data() + size.size() || field.count > (1u << 24))
          refuse(l.number, "the size of an array is \"" + std::string(size) + "\"");
      }
    }
    type = type.substr(0, type.find("<="));  // a bound of a string's length
    if (const auto number = number_named(type, dialect_)) {
      field.number = *number;
      add(std::move(field), l.number, fields);
    } else if (type == "string" || type == "wstring") {
      if (type == "wstring") refuse(l.number, "wstring is not supported");
      field.kind = MessageField::Kind::text;
      add(std::move(field), l.number, fields);
    } else {
      add_structure(std::string(type), package, std::move(field), l.number, depth, fields);
    }
  }

  void add_structure(const std::string& type, const std::string& package, MessageField field,
                     std::size_t line, int depth, std::vector<MessageField>& fields) {
    const bool is_time = dialect_ == Dialect::ros1 && (type == "time" || type == "duration");
    const std::string name = is_time ? type : full_name(type, package);
    if (field.arity == MessageField::Arity::one) {
      if (is_time) return add_time(type, field.path + ".", line, fields);
      return add_members(name, field.path + ".", depth + 1, line, fields);
    }
    field.kind = MessageField::Kind::structure;
    auto& known = structures_[name];
    if (!known) {
      MessageType structure{name, {}};
      if (is_time) {
        add_time(type, "", line, structure.fields);
      } else {
        structure = this->type(name, depth + 1, line);
      }
      known = std::make_shared<const MessageType>(std::move(structure));
    }
    field.structure = structures_[name];
    add(std::move(field), line, fields);
  }

  void add_time(const std::string& type, const std::string& prefix, std::size_t line,
                std::vector<MessageField>& fields) {
    const ValueType number = type == "time" ? ValueType::uint32 : ValueType::int32;
    for (const char* part : {"sec", "nanosec"}) {
      MessageField field;
      field.path = prefix + part;
      field.number = number;
      add(std::move(field), line, fields);
    }
  }

  void add(MessageField field, std::size_t line, std::vector<MessageField>& fields) {
    if (++count_ > kMaxFields) refuse(line, "more than " + std::to_string(kMaxFields) + " fields");
    fields.push_back(std::move(field));
  }

  std::string full_name(const std::string& type, const std::string& package) const {
    if (type.find('/') != std::string::npos) return plain_type(type);
    if (type == "Header") return "std_msgs/Header";
    return package + "/" + type;
  }

  const Definitions& definitions_;
  Dialect dialect_;
  std::map<std::string, std::shared_ptr<const MessageType>> structures_;
  std::size_t count_ = 0;
};

}  // namespace

MessageType parse_message_type(const std::string& name, std::string_view definition, Dialect dialect) {
  const Definitions definitions = split(name, definition);
  return Flattener(definitions, dialect).type(plain_type(name), 0, 1);
}

}  // namespace karst::replay
