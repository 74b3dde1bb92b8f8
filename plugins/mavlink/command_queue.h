// Commands to the autopilot, one at a time: each is repeated until it is answered.
#pragma once
#include <deque>
#include <functional>
#include <optional>

#include "core_stack/common/time.h"
#include "plugins/mavlink/wire/messages.h"

namespace karst::mavlink {

/// Numbers of MAV_CMD and MAV_RESULT that karst uses.
enum class Cmd : std::uint16_t {
  nav_takeoff = 22,
  do_set_mode = 176,
  component_arm_disarm = 400,
  set_message_interval = 511
};
enum class CmdResult : std::uint8_t {
  accepted = 0,
  temporarily_rejected = 1,
  denied = 2,
  unsupported = 3,
  failed = 4,
  in_progress = 5,
  cancelled = 6,
  no_answer = 255  // none to any of the repetitions
};
const char* text_of(CmdResult);

class CommandQueue {
 public:
  using Done = std::function<void(CmdResult)>;
  void add(const CommandLong& command, Done done = {});
  bool waits_for(Cmd command) const;
  /// What to send now.
  std::optional<CommandLong> due(core::TimeNs now);
  void on_ack(const CommandAck& ack);
  void clear() { queue_.clear(); }

 private:
  struct Waiting {
    CommandLong command;
    Done done;
    int sent = 0;
    core::TimeNs sent_at = 0;
  };
  void finish(CmdResult result);

  std::deque<Waiting> queue_;
};

}  // namespace karst::mavlink
