#include "sdk/host/plugin/parameters.h"

#include "sdk/host/boundary/text.h"

namespace karst::host {
namespace {

constexpr const char* kPath = "policy.parameters";  // in a mission file

}  // namespace

std::vector<std::string> split_choices(const std::string& choices) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < choices.size();) {
    const std::size_t bar = std::min(choices.find('|', at), choices.size());
    out.push_back(choices.substr(at, bar - at));
    at = bar + 1;
  }
  return out;
}

ResolvedParameters::ResolvedParameters(const karst_policy_descriptor_t& descriptor,
                                       const boost::property_tree::ptree& given, const std::string& source) {
  core::OptionTable table;
  const auto declare = [&](core::OptionTable& t) {
    for (std::uint32_t i = 0; i < descriptor.parameter_count; ++i) {
      const karst_parameter_t& p = descriptor.parameters[i];
      Field& f = fields_.emplace_back(Field{string_of(p.id), p.type, 0.0});
      const std::string help = string_of(p.help);
      switch (p.type) {
        case KARST_PARAMETER_REAL:
          f.value = p.default_number;
          t.add(f.id, std::get<double>(f.value), string_of(p.unit), p.low, p.high, help);
          break;
        case KARST_PARAMETER_INTEGER:
          f.value = static_cast<std::int64_t>(p.default_number);
          t.add(f.id, std::get<std::int64_t>(f.value), p.low, p.high, help);
          break;
        case KARST_PARAMETER_BOOLEAN:
          f.value = p.default_number != 0.0;
          t.add(f.id, std::get<bool>(f.value), help);
          break;
        default:
          f.value = string_of(p.default_text);
          t.add(f.id, std::get<std::string>(f.value), split_choices(string_of(p.choices)), help);
      }
    }
  };
  table.under(kPath, declare);
  boost::property_tree::ptree mission;
  mission.put_child(kPath, given);
  if (!given.empty()) table.read(source, mission);
  tree_ = table.resolved().get_child(kPath, {});
}

std::vector<karst_parameter_value_t> ResolvedParameters::values() const {
  struct Number {
    double operator()(double v) const { return v; }
    double operator()(std::int64_t v) const { return static_cast<double>(v); }
    double operator()(bool v) const { return v ? 1.0 : 0.0; }
    double operator()(const std::string&) const { return 0.0; }
  };
  std::vector<karst_parameter_value_t> out;
  for (const Field& f : fields_) {
    const std::string* text = std::get_if<std::string>(&f.value);
    out.push_back({view_of(f.id), text ? view_of(*text) : karst_text_t{nullptr, 0},
                   std::visit(Number{}, f.value), f.type, 0});
  }
  return out;
}

}  // namespace karst::host
