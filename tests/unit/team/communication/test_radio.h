// Radios that share the key of a test, and frames under it.
#pragma once
#include "core_stack/team/communication/plausible.h"

namespace karst::core::testing {

inline MissionKey test_key() { return key_of_seed(7); }

/// Of a team of as many robots as messages can name.
inline TeamRadio radio(RobotId self) { return {.self = self, .key = test_key()}; }

inline std::optional<Bytes> write_frame(const Frame& frame) { return core::write_frame(frame, test_key()); }
inline std::optional<Frame> read_frame(std::span<const std::uint8_t> bytes, Refusal& why) {
  return core::read_frame(bytes, test_key(), why);
}

}  // namespace karst::core::testing
