// JSON as text, whatever bytes the texts in it hold.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace karst::core {

/// What is no UTF-8 becomes U+FFFD: names of files may be any bytes, and dump() throws at them. `indent` -1:
/// one line.
template <class Json>
std::string json_text(const Json& j, int indent = -1) {
  return j.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace karst::core
