#include "sdk/evaluation/metrics/policy_restart.h"

#include <charconv>
#include <cstring>
#include <string_view>
#include <system_error>

#include "core_stack/common/format_text.h"

namespace karst::evaluation {
namespace {

namespace event = core::event;

// As sdk/host/isolation words it.
constexpr std::string_view kLogged = "warning: ";
constexpr std::string_view kRestarted = " broke, and was started once more: ";
constexpr std::string_view kProcessEnded = "its process ended in ";
constexpr std::string_view kKilled = "killed by signal ";

/// Cuts `text` at the last `mark` and returns what follows that; "" without the mark.
std::string_view cut_last(std::string_view& text, std::string_view mark) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string_view::npos) return "";
  const std::string_view rest = text.substr(at + mark.size());
  text = text.substr(0, at);
  return rest;
}

/// "SIGSEGV" of "killed by signal 11 (Segmentation fault)"; other ends as they stand.
std::string end_text(std::string_view end) {
  if (!end.starts_with(kKilled)) return std::string(end);
  int signal = 0;
  const std::string_view number = end.substr(kKilled.size());
  std::from_chars(number.data(), number.data() + number.size(), signal);
  const char* name = sigabbrev_np(signal);
  return name != nullptr ? std::string("SIG") + name : std::string(end);
}

/// `why`: "its process ended in decide(): killed by signal 11 (Segmentation fault), request 5 at 8.4 s".
PolicyRestart restart_of(std::string_view policy, std::string_view why, double recorded_s) {
  PolicyRestart restart{std::string(policy), recorded_s, "broke", ""};
  std::string_view said = why;
  std::string asked;
  for (const std::string_view kind : {"request ", "event "}) {
    std::string_view place = cut_last(said, ", " + std::string(kind));
    if (place.empty()) continue;
    const std::string_view time = cut_last(place, " at ");
    double time_s = 0;
    if (std::from_chars(time.data(), time.data() + time.size(), time_s).ec == std::errc())
      restart.time_s = time_s;
    asked = ", " + std::string(kind) + std::string(place);
    break;
  }
  if (const std::size_t colon = said.find(": ");
      said.starts_with(kProcessEnded) && colon != std::string_view::npos) {
    const std::string_view call = said.substr(kProcessEnded.size(), colon - kProcessEnded.size());
    const std::string_view end = said.substr(colon + 2);
    restart.what = end.starts_with(kKilled) ? "crashed" : "ended its process";
    restart.detail = " in " + std::string(call) + asked + " (" + end_text(end) + ")";
  } else {
    restart.detail = asked + " (" + std::string(said) + ")";
  }
  return restart;
}

}  // namespace

std::optional<PolicyRestart> policy_restart(const RunRecord& run) {
  for (const nlohmann::json& e : run.events) {
    // The log, since another answer may have taken the place of this decision's.
    const auto log = event::as<event::Log>(e);
    if (!log || !log->text.starts_with(kLogged)) continue;
    const std::string_view text = std::string_view(log->text).substr(kLogged.size());
    const std::size_t at = text.find(kRestarted);
    if (at == std::string_view::npos) continue;
    return restart_of(text.substr(0, at), text.substr(at + kRestarted.size()), e["t"].get<double>());
  }
  return std::nullopt;
}

std::string sentence_of(const PolicyRestart& restart) {
  return restart.policy + " " + restart.what + core::format_text(" at %.1f s", restart.time_s) +
         restart.detail + ", and was started once more";
}

}  // namespace karst::evaluation
