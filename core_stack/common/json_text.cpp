#include "core_stack/common/json_text.h"

namespace karst::core {
namespace {

template <class Json>
std::string text_of(const Json& j, int indent, JsonCharacters characters) {
  return j.dump(indent, ' ', characters == JsonCharacters::ascii, Json::error_handler_t::replace);
}

template <class Json>
Json parsed(std::string_view text) {
  const auto shallow = [](int depth, typename Json::parse_event_t, Json&) { return depth <= 100; };
  return Json::parse(text, shallow, false);
}

}  // namespace

std::string json_text(const nlohmann::json& j, int indent, JsonCharacters characters) {
  return text_of(j, indent, characters);
}

std::string json_text(const nlohmann::ordered_json& j, int indent, JsonCharacters characters) {
  return text_of(j, indent, characters);
}

template <>
nlohmann::json json_of<nlohmann::json>(std::string_view text) {
  return parsed<nlohmann::json>(text);
}

template <>
nlohmann::ordered_json json_of<nlohmann::ordered_json>(std::string_view text) {
  return parsed<nlohmann::ordered_json>(text);
}

}  // namespace karst::core
