#include "sdk/mcap_export/event_words.h"

#include <cmath>

#include "core_stack/common/format_text.h"

namespace karst::mcap {
namespace {

namespace event = core::event;
using core::format_text;
using core::name_of;

/// "goal accepted: 2.4 m away; seen"
std::string sentence(std::string head, std::initializer_list<std::string> reasons) {
  const char* separator = ": ";
  for (const std::string& reason : reasons) {
    if (reason.empty()) continue;
    head += separator + reason;
    separator = "; ";
  }
  return head;
}

std::string place(const core::Vec3& p) { return format_text("(%.1f %.1f %.1f)", p.x(), p.y(), p.z()); }

template <class E>
EventWords line(Severity severity, std::string text) {
  return {severity, E::kKind, std::move(text)};
}

Severity severity_of(core::SafetyAction action) {
  switch (action) {
    case core::SafetyAction::none:
      return Severity::info;
    case core::SafetyAction::replan:
    case core::SafetyAction::fallback:
    case core::SafetyAction::slow:
    case core::SafetyAction::brake:
      return Severity::warn;
    case core::SafetyAction::home:
    case core::SafetyAction::land:
      return Severity::error;
  }
  return Severity::error;
}

struct Words {
  using Result = std::optional<EventWords>;

  Result operator()(const event::Phase& e) const {
    return line<event::Phase>(Severity::info, sentence(name_of(e.phase), {e.reason}));
  }
  Result operator()(const event::Selection& e) const {
    return line<event::Selection>(Severity::info, sentence("policy " + e.policy, {e.reason}));
  }
  Result operator()(const event::Decision& e) const {
    return line<event::Decision>(
        Severity::debug, sentence(format_text("%s decides %s, %llu goals of %llu frontiers", e.policy.c_str(),
                                              name_of(e.outcome), static_cast<unsigned long long>(e.goals),
                                              static_cast<unsigned long long>(e.frontiers)),
                                  {e.reason}));
  }
  Result operator()(const event::Frontiers&) const { return std::nullopt; }
  Result operator()(const event::Drawing&) const { return std::nullopt; }
  Result operator()(const event::Frontier& e) const {
    return line<event::Frontier>(Severity::info, sentence(format_text("frontier %u at ", e.id) +
                                                              place(e.position) + " " + name_of(e.state),
                                                          {e.reason}));
  }
  Result operator()(const event::Goal& e) const {
    const std::string score = std::isfinite(e.score) ? format_text(", score %.2f", e.score) : "";
    return line<event::Goal>(
        Severity::info,
        sentence("goal at " + place(e.position) + " " + name_of(e.state) + score, {e.why, e.reason}));
  }
  Result operator()(const event::Plan& e) const {
    return line<event::Plan>(
        Severity::debug, sentence(format_text("path of %.1f m", e.length_m) + (e.narrow ? ", narrow" : ""),
                                  {e.fell_back.value_or("")}));
  }
  Result operator()(const event::Object& e) const {
    return line<event::Object>(Severity::info, format_text("object %u ", e.number) + name_of(e.state) +
                                                   (e.what ? std::string(": ") + name_of(*e.what) : "") +
                                                   (e.position ? " at " + place(*e.position) : ""));
  }
  Result operator()(const event::Log& e) const { return line<event::Log>(Severity::info, e.text); }
  Result operator()(const event::Homing& e) const {
    return line<event::Homing>(Severity::info,
                               sentence(format_text("home, %.1f m, %.0f s needed, %.0f s left", e.distance_m,
                                                    e.seconds_needed, e.seconds_left),
                                        {e.reason}));
  }
  Result operator()(const event::Safety& e) const {
    return line<event::Safety>(severity_of(e.action), sentence(name_of(e.action), {e.reason}));
  }
  Result operator()(const event::SpeedLimit&) const { return std::nullopt; }
  Result operator()(const event::Authority& e) const {
    return line<event::Authority>(Severity::warn,
                                  sentence(std::string(name_of(e.who)) + " steers", {e.reason}));
  }
  Result operator()(const event::Overrun& e) const {
    return line<event::Overrun>(Severity::warn, format_text("%d jobs were late", e.count));
  }
  Result operator()(const event::Degraded& e) const {
    return line<event::Degraded>(Severity::warn,
                                 sentence(std::string(name_of(e.what)) + " " + name_of(e.state), {e.reason}));
  }
  Result operator()(const event::Localization& e) const {
    const bool good = e.state ? *e.state == event::LocalizationState::found
                              : e.valid.value_or(true) && e.accepted.value_or(true);
    return line<event::Localization>(good ? Severity::info : Severity::warn,
                                     sentence(good ? "localized" : "not localized", {e.reason}));
  }
  Result operator()(const event::EarlierMap& e) const {
    const bool found = e.state == event::EarlierMapState::found;
    return line<event::EarlierMap>(
        found ? Severity::info : Severity::warn,
        sentence(std::string("place in the earlier map ") + name_of(e.state), {e.reason}));
  }
  Result operator()(const event::Landing& e) const {
    return line<event::Landing>(
        Severity::info, sentence(std::string("landing place ") + name_of(e.state), {e.reason.value_or("")}));
  }
  Result operator()(const event::Drop& e) const {
    return line<event::Drop>(Severity::info, "node dropped at " + place(e.ground));
  }
  Result operator()(const event::Team& e) const {
    return line<event::Team>(
        Severity::info, name_of(e.action) + (e.robot ? format_text(", robot %u", *e.robot) : std::string()));
  }
  Result operator()(const event::Outcome& e) const {
    const bool good =
        e.outcome == core::MissionOutcome::landed || e.outcome == core::MissionOutcome::replayed;
    return line<event::Outcome>(good ? Severity::info : Severity::error,
                                sentence(name_of(e.outcome), {e.reason}));
  }
};

}  // namespace

std::optional<EventWords> words_of(const event::Event& event) { return std::visit(Words{}, event); }

}  // namespace karst::mcap
