// JSON out of a file that may not be there, or be anything.
#pragma once
#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"

namespace karst::core {

/// The JSON in `file`; discarded (`is_discarded()`) if that is no regular file or holds none.
template <class Json = nlohmann::json>
Json json_of_file(const std::string& file) {
  try {
    return json_of<Json>(read_input(file, kMaxTextFileBytes));
  } catch (const InputError&) {
    return Json(Json::value_t::discarded);
  }
}

}  // namespace karst::core
