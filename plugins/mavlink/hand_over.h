// Who steers, by what the autopilot says of itself: the core while the autopilot is armed and follows
// setpoints, the autopilot while it flies by itself because of a failsafe or is silent, and the pilot
// otherwise.
#pragma once
#include <optional>
#include <string>

#include "core_stack/common/time.h"
#include "core_stack/vehicle/authority.h"
#include "plugins/mavlink/firmware.h"
#include "plugins/mavlink/wire/messages.h"

namespace karst::mavlink {

/// Who selects the mode in which the autopilot follows setpoints.
enum class Engage {
  pilot,  // the pilot, by the switch or the ground station
  arming  // karst asks for it once the pilot has armed the vehicle on the ground
};
constexpr auto names_of(Engage) {
  using enum Engage;
  return std::to_array<core::Named<Engage>>({{pilot, "pilot"}, {arming, "arming"}});
}

/// Whether karst asks for that mode again.
enum class Resume {
  never,
  after_link_loss  // if the autopilot left the mode because it heard nothing from karst, and for no other
                   // reason
};
constexpr auto names_of(Resume) {
  using enum Resume;
  return std::to_array<core::Named<Resume>>({{never, "never"}, {after_link_loss, "after_link_loss"}});
}

class HandOver {
 public:
  HandOver(Firmware firmware, Engage engage, Resume resume)
      : firmware_(firmware), engage_(engage), resume_(resume) {}

  struct Steering {
    core::Authority who = core::Authority::pilot;
    std::string reason;
  };

  void on_heartbeat(const Heartbeat& heartbeat, core::TimeNs now);
  void on_text(const Statustext& text, core::TimeNs now);
  void on_any_message(core::TimeNs now);
  void on_ground(bool standing) { standing_ = standing; }
  /// The autopilot did not grant the mode.
  void on_refused(const std::string& why);

  /// To be called in every step.
  Steering steering(core::TimeNs now);
  /// Whether to ask for the mode now; `streaming`: setpoints have been sent for a second.
  bool asks(core::TimeNs now, bool streaming);

  bool connected(core::TimeNs now) const;
  bool heard() const { return heartbeat_at_.has_value(); }  // since the start
  bool armed() const { return armed_; }
  bool follows_setpoints() const { return mode_ && mode_->flown_by == FlownBy::setpoints; }

 private:
  void note_silence(core::TimeNs now);
  void on_mode(const Mode& mode, bool failsafe, core::TimeNs now);
  bool says_recently(core::TimeNs now, const char* word) const;

  Firmware firmware_;
  Engage engage_;
  Resume resume_;
  std::optional<Mode> mode_;
  bool armed_ = false, standing_ = false;
  bool seen_disarmed_ = false;  // since the start
  std::optional<core::TimeNs> heard_at_, heartbeat_at_, asked_at_;
  bool silent_ = false;
  bool steered_before_silence_ = false;             // the next heartbeat tells what became of it
  core::Authority other_ = core::Authority::pilot;  // who steers while it does not follow setpoints, and why
  std::string why_not_;
  bool left_for_silence_ = false;  // it left the mode as it heard nothing from karst
  bool spent_ = false;             // the mode must be selected again
  bool followed_since_armed_ = false;
  std::string text_;
  core::TimeNs text_at_ = 0;
  std::string refused_;
};

}  // namespace karst::mavlink
