// A host of the ABI 1.1 of docs/abi.md's worked example: opens plugins as `karst` does, over a map drawn by
// hand, and prints what each answers. Built against the grown headers, by growth_test.sh only.
//   host_1_1 PLUGIN offers|bare
#include <karst/testing/bench.h>

#include <cstdio>
#include <string>

#include "sdk/host/plugin/plugin_file.h"

namespace {

using namespace karst::testing;

std::int32_t distances(const karst_host_t* h, const karst_map_t*, const karst_vec3_t* points,
                       std::uint64_t count, double limit_m, double* out, karst_error_t*) noexcept {
  const DrawnMap& map = static_cast<const DrawnHost*>(h->context)->map();
  for (std::uint64_t i = 0; i < count; ++i) {
    out[i] = limit_m;
    for (const auto& [index, cell] : map.known())
      if (cell == karst::Cell::occupied)
        out[i] = std::min(out[i], karst::distance(points[i], map.center_of(index)));
  }
  return KARST_OK;
}

/// A policy from its file, through the host's own handshake, asked once.
int ask(const karst_policy_t& policy, bool offers) {
  DrawnHost drawn(DrawnMap(1.0, {R"(
    #######
    #.....#
    #..s.e#
    #.....#
    #######)"}));
  karst_clearance_service_t clearance{sizeof clearance, 0, &distances};
  karst_host_t host = *drawn.host();
  host.clearance = offers ? &clearance : nullptr;
  std::vector<karst_parameter_value_t> values;
  for (std::uint32_t i = 0; i < policy.descriptor->parameter_count; ++i) {
    const karst_parameter_t& p = policy.descriptor->parameters[i];
    values.push_back({p.id, p.default_text, p.default_number, p.type, 0});
  }
  karst_error_t error{};
  void* const self = policy.create(&host, &error);
  if (self == nullptr || policy.init(self, values.data(), values.size(), &error) != KARST_OK ||
      policy.activate(self, &error) != KARST_OK)
    return std::printf("%s\n", error.text), 1;
  karst_frontier_cluster_t frontier{};
  frontier.id = 1;
  frontier.cells = 20;
  frontier.centroid = frontier.viewpoint.position = drawn.map().place('e');
  frontier.path_length_m = 2;
  karst_request_t request{};
  request.size = sizeof request;
  request.sequence = 1;
  request.state.position = drawn.map().place('s');
  request.map = drawn.map_handle();
  request.direction_of_flight.x = 1;
  request.frontiers = &frontier;
  request.frontier_count = 1;
  request.battery_left_wh = offers ? 40.0 : 0.0;
  karst_decision_sink_t sink{sizeof sink, 64, nullptr, nullptr, nullptr};
  sink.add_goals = [](const karst_decision_sink_t*, const karst_goal_t* goals, std::uint64_t count,
                      karst_error_t*) noexcept -> std::int32_t {
    for (std::uint64_t i = 0; i < count; ++i)
      std::printf("goal: %.*s\n", static_cast<int>(goals[i].why.length), goals[i].why.data);
    return KARST_OK;
  };
  sink.set_outcome = [](const karst_decision_sink_t*, karst_outcome_t outcome, std::uint32_t,
                        karst_text_t reason, karst_error_t*) noexcept -> std::int32_t {
    std::printf("outcome %u: %.*s\n", outcome, static_cast<int>(reason.length), reason.data);
    return KARST_OK;
  };
  if (policy.decide(self, &request, &sink, &error) != KARST_OK) return std::printf("%s\n", error.text), 1;
  for (const std::string& line : drawn.log_lines) std::printf("log: %s\n", line.c_str());
  policy.deactivate(self);
  policy.destroy(self);
  return 0;
}

}  // namespace

int main(int, char** argv) try {
  const karst::host::PluginFile file = karst::host::open_plugin(argv[1]);
  std::printf("built for %u.%u\n", file.plugin->abi_major, file.plugin->abi_minor);
  return ask(*file.policies.at(0), std::string(argv[2]) == "offers");
} catch (const std::exception& e) {
  std::printf("%s\n", e.what());
  return 1;
}
