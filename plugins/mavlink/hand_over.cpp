#include "plugins/mavlink/hand_over.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace karst::mavlink {
namespace {

using core::Authority;
using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

/// Telemetry comes two hundred times a second, heartbeats once: three of them may be missing. The sooner a
/// lost link is known, the less the core takes for flown what it commanded to nobody.
constexpr TimeNs kSilence = 400 * kMillisecond, kHeartbeatsMissing = 3 * kSecond + kSecond / 2;
/// A text explains a change of mode that comes up to so much later.
constexpr TimeNs kTextMatters = 3 * kSecond;
constexpr TimeNs kAskAgain = kSecond;
constexpr std::uint8_t kWarning = 4;  // MAV_SEVERITY: lower is worse

}  // namespace

bool HandOver::connected(TimeNs now) const {
  return heartbeat_at_ && now - *heard_at_ <= kSilence && now - *heartbeat_at_ <= kHeartbeatsMissing;
}

void HandOver::note_silence(TimeNs now) {
  if (!heartbeat_at_ || silent_ || connected(now)) return;
  silent_ = true;
  steered_before_silence_ = armed_ && follows_setpoints() && !spent_;
}

void HandOver::on_any_message(TimeNs now) {
  note_silence(now);
  heard_at_ = now;
}

void HandOver::on_text(const Statustext& text, TimeNs now) {
  if (text.severity > kWarning) return;
  text_.assign(text.text.begin(), std::find(text.text.begin(), text.text.end(), '\0'));
  text_at_ = now;
  // It may come after the heartbeat that it explains.
  if (mode_ && mode_->flown_by == FlownBy::itself && other_ == Authority::autopilot &&
      why_not_.find(": ") == std::string::npos)
    why_not_ += ": " + text_;
  if (mode_ && mode_->name == "hold" && says_recently(now, "offboard") && says_recently(now, "lost"))
    left_for_silence_ = true;
}

bool HandOver::says_recently(TimeNs now, const char* word) const {
  std::string small = text_;
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return now - text_at_ <= kTextMatters && small.find(word) != std::string::npos;
}

void HandOver::on_heartbeat(const Heartbeat& heartbeat, TimeNs now) {
  on_any_message(now);
  heartbeat_at_ = now;
  const bool armed = (heartbeat.base_mode & kArmed) != 0;
  if (armed && !armed_) followed_since_armed_ = false;
  seen_disarmed_ = seen_disarmed_ || !armed;
  armed_ = armed;
  const Mode mode = mode_of(firmware_, heartbeat.custom_mode);
  if (!mode_ || mode_->name != mode.name) on_mode(mode, heartbeat.system_status >= kCritical, now);
  if (follows_setpoints() && armed_) followed_since_armed_ = true;
  if (std::exchange(silent_, false) && steered_before_silence_ && resume_ == Resume::never)
    spent_ = follows_setpoints();
  steered_before_silence_ = false;
}

void HandOver::on_mode(const Mode& mode, bool failsafe, TimeNs now) {
  mode_ = mode;
  refused_.clear();
  spent_ = false;
  left_for_silence_ = false;
  if (mode.flown_by == FlownBy::setpoints) return;
  const bool explained = says_recently(now, "failsafe") || says_recently(now, "lost");
  const bool by_itself = mode.flown_by == FlownBy::itself && (failsafe || explained);
  other_ = by_itself ? Authority::autopilot : Authority::pilot;
  why_not_ = "mode " + mode.name;
  if (by_itself && now - text_at_ <= kTextMatters && !text_.empty()) why_not_ += ": " + text_;
  // A hold alone: who lands or returns has another reason, or wants to be asked by the pilot.
  const bool offboard_lost = says_recently(now, "offboard") && says_recently(now, "lost");
  left_for_silence_ = by_itself && mode.name == "hold" && (steered_before_silence_ || offboard_lost);
}

void HandOver::on_refused(const std::string& why) {
  refused_ = "mode " + mode_of(firmware_, setpoint_mode(firmware_)).name + " refused: " + why;
}

HandOver::Steering HandOver::steering(TimeNs now) {
  note_silence(now);
  if (!heartbeat_at_) return {Authority::pilot, "no autopilot yet"};
  if (silent_) return {Authority::autopilot, "no heartbeat"};
  if (!armed_) return {Authority::pilot, "not armed"};
  if (spent_) return {Authority::pilot, "the link was lost: waits to be handed over again"};
  if (follows_setpoints()) return {Authority::core, "mode " + mode_->name};
  return {other_, refused_.empty() ? why_not_ : refused_};
}

bool HandOver::asks(TimeNs now, bool streaming) {
  if (!streaming || !connected(now) || silent_ || !armed_ || follows_setpoints()) return false;
  if (asked_at_ && now - *asked_at_ < kAskAgain) return false;
  const bool first = engage_ == Engage::arming && seen_disarmed_ && standing_ && !followed_since_armed_;
  const bool again = resume_ == Resume::after_link_loss && left_for_silence_;
  if (!first && !again) return false;
  asked_at_ = now;
  return true;
}

}  // namespace karst::mavlink
