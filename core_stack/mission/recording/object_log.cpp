#include "core_stack/mission/recording/object_log.h"

#include <nlohmann/json.hpp>

#include "core_stack/common/json_point.h"
#include "core_stack/vehicle/object_detection.h"

namespace karst::core {
namespace {

const char* name(std::uint8_t kind) { return name_of(static_cast<ObjectKind>(kind)); }

}  // namespace

nlohmann::json list_of(const std::vector<TeamObject>& objects) {
  nlohmann::json all = nlohmann::json::array();
  for (const TeamObject& o : objects)
    all.push_back({{"what", name(o.kind)},
                   {"position", rounded_list(o.position)},
                   {"deviation", to_thousandths(o.deviation_m)},
                   {"told_by", o.reported_by}});
  return all;
}

}  // namespace karst::core
