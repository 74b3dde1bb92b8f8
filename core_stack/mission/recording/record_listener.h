// Who listens to a record while it is written.
#pragma once
#include <cstdint>
#include <string_view>

namespace karst::core {

/// Files of the run directory that tell a flight as it goes.
enum class RecordPart : std::uint8_t { events, trajectory, telemetry, localization, map_growth };

/// Gets the very bytes that the recorder writes, in its order: whole lines, and of map_growth.bin whole
/// records. Calls come on the thread that records, which is the loop's: they must neither wait nor throw.
class RecordListener {
 public:
  virtual ~RecordListener() = default;
  virtual void on_record(RecordPart part, std::string_view bytes) = 0;
  /// The record is complete.
  virtual void on_close() = 0;
};

}  // namespace karst::core
