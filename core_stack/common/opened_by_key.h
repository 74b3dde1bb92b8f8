// What a key of a mission opens: an address, a device, a file.
#pragma once
#include <string>

#include "core_stack/common/error.h"

namespace karst::core {

/// What `open` returns. To its InputError, which names what was opened, the key that gave it is added.
template <class Open>
auto opened_by_key(const std::string& file, const std::string& key, Open open) {
  try {
    return open();
  } catch (const InputError& e) {
    throw InputError(file, key, e.what());
  }
}

}  // namespace karst::core
