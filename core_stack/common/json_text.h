// JSON as text, whatever bytes the texts in it hold, and out of text, however deep.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace karst::core {

/// What is no UTF-8 becomes U+FFFD: names of files may be any bytes, and dump() throws at them. `indent` -1:
/// one line.
template <class Json>
std::string json_text(const Json& j, int indent = -1) {
  return j.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The JSON in a string or a stream; discarded (`is_discarded()`) if it is none. What lies more than 100
/// levels deep is left out: dump() and others call themselves for each level.
template <class Json = nlohmann::json, class Text>
Json json_of(Text&& text) {
  const auto shallow = [](int depth, typename Json::parse_event_t, Json&) { return depth <= 100; };
  return Json::parse(std::forward<Text>(text), shallow, false);
}

}  // namespace karst::core
