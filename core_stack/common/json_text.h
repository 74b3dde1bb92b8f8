// JSON as text, whatever bytes the texts in it hold, and out of text, however deep. Functions rather than
// templates: the library's parser and printer are compiled here once, and not in every source that reads or
// writes.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace karst::core {

enum class JsonCharacters { utf8, ascii };

/// What is no UTF-8 becomes U+FFFD: names of files may be any bytes, and dump() throws at them. `indent` -1:
/// one line.
std::string json_text(const nlohmann::json& j, int indent = -1,
                      JsonCharacters characters = JsonCharacters::utf8);
std::string json_text(const nlohmann::ordered_json& j, int indent = -1,
                      JsonCharacters characters = JsonCharacters::utf8);

/// The JSON in a string; discarded (`is_discarded()`) if it is none. What lies more than 100 levels deep is
/// left out: dump() and others call themselves for each level.
template <class Json = nlohmann::json>
Json json_of(std::string_view text);
template <>
nlohmann::json json_of<nlohmann::json>(std::string_view text);
template <>
nlohmann::ordered_json json_of<nlohmann::ordered_json>(std::string_view text);

}  // namespace karst::core
