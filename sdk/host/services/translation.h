// From core types to the ABI's.
#pragma once
#include <vector>

#include "core_stack/mission/policy/policy_port.h"
#include "sdk/abi/karst_abi_policy.h"

namespace karst::host {

/// A request with all the data it points to, except the map. Owns the data that the policy reads in decide().
class RequestPack {
 public:
  RequestPack(const core::DecisionRequest& request, const karst_map_t* map);
  RequestPack(const RequestPack&) = delete;
  RequestPack& operator=(const RequestPack&) = delete;
  const karst_request_t& request() const { return request_; }

 private:
  std::vector<karst_frontier_cluster_t> frontiers_;
  std::vector<std::string> sensor_names_;
  std::vector<karst_sensor_t> sensors_;
  std::vector<karst_teammate_t> teammates_;
  karst_request_t request_{};
};

/// The sensor's name is left empty.
karst_sensor_t to_abi(const core::RgbCameraModel& camera);

/// A view of `event`, which must outlive it.
karst_event_t to_abi(const core::PolicyEvent& event);

}  // namespace karst::host
