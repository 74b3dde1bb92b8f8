#include "plugins/mavlink/parameters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace karst::mavlink {
namespace {

constexpr core::TimeNs kAskEvery = 50 * core::kMillisecond;
constexpr int kRounds = 8;
constexpr double kAny = 1e9;

ParameterRule within(std::string name, std::string required, double low, double high) {
  return {std::move(name), std::move(required), low, high, {}, 0};
}
ParameterRule one_of(std::string name, std::string required, std::vector<double> values) {
  return {std::move(name), std::move(required), 0, 0, std::move(values), 0};
}
ParameterRule bits(std::string name, std::string required, std::uint32_t set) {
  return {std::move(name), std::move(required), 0, 0, {}, set};
}

std::string text_of(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

ParameterRule hover(std::string name, double hover_thrust) {
  constexpr double kMargin = 0.05;
  return within(std::move(name), "mavlink.hover_thrust, which is " + text_of(hover_thrust) + ", within 0.05",
                hover_thrust - kMargin, hover_thrust + kMargin);
}

/// No failsafe may fly a return: it leads straight through the rock.
std::vector<ParameterRule> px4_rules(Control control, double hover_thrust) {
  std::vector<ParameterRule> rules{
      within("COM_OF_LOSS_T", "at most 1 s", 0, 1),
      one_of("COM_OBL_RC_ACT", "4 (land) or 5 (hold)", {4, 5}),
      bits("COM_RCL_EXCEPT", "bit 2 set: flies on without the pilot's radio in offboard", 4),
      one_of("NAV_RCL_ACT", "1 (hold) or 3 (land)", {1, 3}),
      one_of("NAV_DLL_ACT", "0 (off), 1 (hold) or 3 (land)", {0, 1, 3}),
      one_of("COM_LOW_BAT_ACT", "0 (warning) or 2 (land)", {0, 2}),
      bits("EKF2_EV_CTRL", "bits 0, 1 and 3 set: position, height and yaw by external vision", 11),
      one_of("EKF2_HGT_REF", "3 (vision)", {3}),
      one_of("EKF2_GPS_CTRL", "0: no GPS", {0}),
      within("EKF2_NOAID_TOUT", "10000000 us: dead reckoning for 10 s while the link is lost", 10e6, kAny),
      within("MPC_TILTMAX_AIR", "at least 20 deg", 20, 90),
      within("MPC_XY_VEL_MAX", "at least 2 m/s", 2, kAny),
      within("MPC_Z_VEL_MAX_UP", "at least 1 m/s", 1, kAny),
      within("MPC_Z_VEL_MAX_DN", "at least 1 m/s", 1, kAny)};
  if (control == Control::rates) rules.push_back(hover("MPC_THR_HOVER", hover_thrust));
  return rules;
}

std::vector<ParameterRule> ardupilot_rules(Control control, double hover_thrust) {
  std::vector<ParameterRule> rules{one_of("VISO_TYPE", "1 (MAVLink)", {1}),
                                   one_of("EK3_SRC1_POSXY", "6 (external navigation)", {6}),
                                   one_of("EK3_SRC1_POSZ", "6 (external navigation)", {6}),
                                   one_of("EK3_SRC1_VELXY", "6 (external navigation)", {6}),
                                   one_of("EK3_SRC1_VELZ", "6 (external navigation) or 0 (none)", {0, 6}),
                                   one_of("EK3_SRC1_YAW", "6 (external navigation)", {6}),
                                   within("GUID_TIMEOUT", "at most 3 s", 0.1, 3),
                                   one_of("FS_GCS_ENABLE", "0 (off) or 5 (land)", {0, 5}),
                                   one_of("FS_THR_ENABLE", "0 (off) or 3 (land)", {0, 3}),
                                   one_of("FS_EKF_ACTION", "1 (land) or 3 (land, in all modes)", {1, 3}),
                                   one_of("BATT_FS_LOW_ACT", "0 (warning) or 1 (land)", {0, 1}),
                                   one_of("BATT_FS_CRT_ACT", "0 (warning) or 1 (land)", {0, 1})};
  if (control == Control::rates) {
    rules.push_back(bits("GUID_OPTIONS", "bit 3 set: thrust is thrust, and no climb rate", 8));
    rules.push_back(one_of("ATC_ANGLE_BOOST", "0: the core's thrust holds the tilt already", {0}));
    rules.push_back(hover("MOT_THST_HOVER", hover_thrust));
  }
  return rules;
}

std::string name_in(const std::array<char, 16>& id) {
  return {id.begin(), std::find(id.begin(), id.end(), '\0')};
}

}  // namespace

bool ParameterRule::holds(double value) const {
  if (!std::isfinite(value)) return false;
  if (bits != 0) return value >= 0 && value < kAny && (static_cast<std::uint32_t>(value) & bits) == bits;
  if (!one_of.empty()) return std::find(one_of.begin(), one_of.end(), value) != one_of.end();
  constexpr double kRounding = 1e-6;  // of a float on the wire
  return value >= low - kRounding && value <= high + kRounding;
}

std::vector<ParameterRule> rules_of(Firmware firmware, Control control, double hover_thrust) {
  return firmware == Firmware::px4 ? px4_rules(control, hover_thrust)
                                   : ardupilot_rules(control, hover_thrust);
}

double value_of(const ParamValue& p, Firmware firmware) {
  constexpr std::uint8_t kReal32 = 9, kInt32 = 6, kUint32 = 5;  // MAV_PARAM_TYPE
  if (firmware == Firmware::ardupilot || p.param_type >= kReal32) return static_cast<double>(p.param_value);
  if (p.param_type == kInt32) return std::bit_cast<std::int32_t>(p.param_value);
  if (p.param_type == kUint32) return std::bit_cast<std::uint32_t>(p.param_value);
  return std::bit_cast<std::int32_t>(p.param_value) & 0xffff;
}

std::array<char, 16> parameter_id(const std::string& name) {
  std::array<char, 16> id{};
  std::copy_n(name.begin(), std::min(name.size(), id.size()), id.begin());
  return id;
}

std::optional<ParamRequestRead> ParameterReader::due(core::TimeNs now) {
  if (found_.size() == rules_.size() || rounds_ >= kRounds || now - asked_at_ < kAskEvery)
    return std::nullopt;
  while (next_ < rules_.size() && found_.contains(rules_[next_].name)) ++next_;
  asked_at_ = now;
  if (next_ == rules_.size()) {
    next_ = 0;
    ++rounds_;
    return std::nullopt;
  }
  ParamRequestRead request;
  request.param_id = parameter_id(rules_[next_++].name);
  return request;
}

void ParameterReader::on_value(const ParamValue& value) {
  const std::string name = name_in(value.param_id);
  const bool asked =
      std::any_of(rules_.begin(), rules_.end(), [&](const ParameterRule& r) { return r.name == name; });
  if (asked) found_[name] = value_of(value, firmware_);
}

std::vector<core::VehicleCheck> ParameterReader::checks() const {
  std::vector<core::VehicleCheck> checks;
  for (const ParameterRule& rule : rules_) {
    const auto found = found_.find(rule.name);
    if (found == found_.end())
      checks.push_back({rule.name, rule.required, "", false});
    else
      checks.push_back({rule.name, rule.required, text_of(found->second), rule.holds(found->second)});
  }
  return checks;
}

}  // namespace karst::mavlink
