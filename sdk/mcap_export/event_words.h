// Events of a run as lines of a log.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core_stack/mission/recording/run_event.h"

namespace karst::mcap {

/// rcl_interfaces/Log's levels.
enum class Severity : std::uint8_t { debug = 10, info = 20, warn = 30, error = 40 };

struct EventWords {
  Severity severity = Severity::info;
  std::string kind, text;  // as the event's line in events.jsonl has it; in one sentence
};

/// None of what is drawn only: frontiers, drawings.
std::optional<EventWords> words_of(const core::event::Event& event);

}  // namespace karst::mcap
