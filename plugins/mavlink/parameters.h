// Parameters of the autopilot that must hold, read one by one with PARAM_REQUEST_READ.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/time.h"
#include "core_stack/vehicle/vehicle.h"
#include "plugins/mavlink/firmware.h"
#include "plugins/mavlink/wire/messages.h"

namespace karst::mavlink {

/// How karst has the autopilot fly.
enum class Control { rates, position };
constexpr auto names_of(Control) {
  using enum Control;
  return std::to_array<core::Named<Control>>({{rates, "rates"}, {position, "position"}});
}

struct ParameterRule {
  std::string name;
  std::string required;             // in words
  double low = 0, high = 0;         // within which the value lies
  std::vector<double> one_of = {};  // if not empty: the values allowed
  std::uint32_t bits = 0;           // if not zero: bits that must be set
  bool holds(double value) const;
};

std::vector<ParameterRule> rules_of(Firmware firmware, Control control, double hover_thrust);

/// The value: PX4 sends the bits of an integer in place of a float, ArduPilot the integer as a float.
double value_of(const ParamValue& p, Firmware firmware);
std::array<char, 16> parameter_id(const std::string& name);

class ParameterReader {
 public:
  ParameterReader(std::vector<ParameterRule> rules, Firmware firmware)
      : rules_(std::move(rules)), firmware_(firmware) {}
  /// The next parameter to ask for, if it is time to.
  std::optional<ParamRequestRead> due(core::TimeNs now);
  void on_value(const ParamValue& value);
  std::vector<core::VehicleCheck> checks() const;

 private:
  std::vector<ParameterRule> rules_;
  Firmware firmware_;
  std::map<std::string, double> found_;
  std::size_t next_ = 0;
  int rounds_ = 0;
  core::TimeNs asked_at_ = 0;
};

}  // namespace karst::mavlink
