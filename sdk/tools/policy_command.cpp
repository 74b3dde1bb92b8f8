#include "sdk/tools/policy_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "sdk/host/plugin/discovery.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/policy_new.h"

namespace karst::tools {
namespace {

using host::ParameterListing;
using host::ParameterType;
using host::PolicyListing;
using nlohmann::ordered_json;

struct PolicyArguments {
  std::vector<std::string> plugins;
  bool json = false, verbose = false;
};

ordered_json parameter_json(const ParameterListing& p) {
  ordered_json j{{"id", p.id}, {"type", core::name_of(p.type)}, {"default", p.default_text}};
  if (!p.unit.empty()) j["unit"] = p.unit;
  if (p.type == ParameterType::real || p.type == ParameterType::integer) j["low"] = p.low, j["high"] = p.high;
  if (!p.choices.empty()) j["choices"] = p.choices;
  j["help"] = p.help;
  return j;
}

ordered_json to_json(const PolicyListing& p) {
  if (!p.broken.empty()) return {{"file", p.file}, {"broken", p.broken}};
  ordered_json j{
      {"id", p.id}, {"version", p.version}, {"one_line", p.one_line}, {"abi", p.abi}, {"file", p.file}};
  if (!p.shadowed_by.empty()) j["shadowed_by"] = p.shadowed_by;
  j["parameters"] = ordered_json::array();
  for (const ParameterListing& q : p.parameters) j["parameters"].push_back(parameter_json(q));
  return j;
}

void print_listings(const std::vector<PolicyListing>& all) {
  ordered_json out{{"policies", ordered_json::array()}, {"broken", ordered_json::array()}};
  for (const PolicyListing& p : all) out[p.broken.empty() ? "policies" : "broken"].push_back(to_json(p));
  print_json(out);
}

std::string allowed_text(const ParameterListing& p) {
  if (p.type == ParameterType::boolean) return "true or false";
  const auto number = [](double v) {
    std::ostringstream s;
    s << v;
    return s.str();
  };
  if (p.type != ParameterType::text)
    return number(p.low) + " to " + number(p.high) + (p.unit.empty() ? "" : " " + p.unit);
  std::string out = p.choices.empty() ? "any text" : "";
  for (const std::string& c : p.choices) out += (out.empty() ? "" : ", ") + c;
  return out;
}

void print_text(const std::vector<PolicyListing>& all, const host::SearchPath& path, bool verbose) {
  for (const PolicyListing& p : all) {
    if (!p.broken.empty()) continue;
    print_out("%s %s\n    %s\n    %s\n", p.id.c_str(), p.version.c_str(), p.one_line.c_str(), p.file.c_str());
    if (!p.shadowed_by.empty()) print_out("    hidden by %s\n", p.shadowed_by.c_str());
    if (!verbose) continue;
    for (const ParameterListing& q : p.parameters)
      print_out("      %s = %s  (%s)\n          %s\n", q.id.c_str(),
                (q.default_text + (q.unit.empty() ? "" : " " + q.unit)).c_str(), allowed_text(q).c_str(),
                q.help.c_str());
  }
  for (const PolicyListing& p : all)
    if (!p.broken.empty()) print_wrapped(stdout, 4, "broken: %s\n    %s\n", p.file.c_str(), p.broken.c_str());
  if (!all.empty() && !verbose) return;
  print_out("%s:\n", all.empty() ? "no policies found; searched" : "searched");
  for (const std::string& folder : path.folders) print_out("    %s\n", folder.c_str());
}

}  // namespace

CLI::App& add_policy_command(CLI::App& app) {
  auto args = std::make_shared<PolicyArguments>();
  CLI::App* policy = app.add_subcommand("policy", "List, write, test and replay exploration policies");
  policy->require_subcommand(1);
  add_policy_new(*policy);
  CLI::App* list =
      policy->add_subcommand("list", "List policies, and plugins that are broken with the reason");
  list->add_option("--plugin", args->plugins, "file with policies (.so or .py) to look at first")
      ->type_name(kFile)
      ->allow_extra_args(false)
      ->check(not_empty());
  list->add_flag("--json", args->json, "write JSON");
  list->add_flag("--verbose,-v", args->verbose, "with parameters and the folders searched");
  list->callback([args] {
    const host::SearchPath path = host::default_search_path(args->plugins);
    const std::vector<PolicyListing> all = host::list_policies(path);
    if (args->json)
      print_listings(all);
    else
      print_text(all, path, args->verbose);
    const bool asked_for_broken = std::any_of(all.begin(), all.end(), [&](const PolicyListing& p) {
      return !p.broken.empty() && std::any_of(args->plugins.begin(), args->plugins.end(), [&](const auto& f) {
        return std::filesystem::weakly_canonical(f) == std::filesystem::weakly_canonical(p.file);
      });
    });
    if (asked_for_broken) throw CLI::RuntimeError(1);
  });
  return *policy;
}

}  // namespace karst::tools
