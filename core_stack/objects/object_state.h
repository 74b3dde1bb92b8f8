// What becomes of an object of interest.
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class ObjectState {
  found,
  revised,
  withdrawn,  // it is another one of its finder's numbers
  reported    // the base knows it, as far as its finder does
};
constexpr auto names_of(ObjectState) {
  using enum ObjectState;
  return std::to_array<Named<ObjectState>>(
      {{found, "found"}, {revised, "revised"}, {withdrawn, "withdrawn"}, {reported, "reported"}});
}

}  // namespace karst::core
