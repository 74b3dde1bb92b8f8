#include "sdk/cave_drawing/run_record.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/json_file.h"
#include "core_stack/mapping/region/region_keys.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::cave_drawing {
namespace {

namespace fs = std::filesystem;

std::vector<Find> finds_of(const fs::path& file) {
  std::vector<Find> finds;
  if (!fs::exists(file)) return finds;
  const auto objects = core::json_of_file<nlohmann::json>(file.string());
  if (!objects.is_object()) throw core::InputError(file.string(), "", "is no JSON object");
  for (const nlohmann::json& found : objects.value("found", nlohmann::json::array())) {
    const bool good = found.is_object() && found.contains("position") && found["position"].is_array() &&
                      found["position"].size() == 3;
    if (!good) throw core::InputError(file.string(), "found", "an object has no position of three numbers");
    core::Vec3 p = core::Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      if (!found["position"][i].is_number())
        throw core::InputError(file.string(), "found", "an object has no position of three numbers");
      p[static_cast<Eigen::Index>(i)] = found["position"][i].get<double>();
    }
    const auto what = found.find("what");
    finds.push_back({what != found.end() && what->is_string() ? what->get<std::string>() : "object", p});
  }
  return finds;
}

/// A run without a readable mission is drawn without its region.
std::shared_ptr<const core::FlightRegion> region_of_run(const fs::path& mission) {
  try {
    return core::region_in(mission.string(), core::read_info(mission.string()));
  } catch (const core::InputError&) {
    return nullptr;
  }
}

}  // namespace

FlightRecord flight_record(const fs::path& run) {
  FlightRecord record;
  record.from = "flight";
  std::vector<std::string> problems;  // what is missing is left out
  for (const evaluation::Setting& s : evaluation::read_settings(run / "mission.info", problems))
    if (s.key == "cave.file") record.name = fs::path(s.value).stem().string();
  record.region = region_of_run(run / "mission.info");
  if (record.name.empty()) record.name = fs::absolute(run).lexically_normal().filename().string();
  for (const evaluation::StampedPose& pose : evaluation::read_tum(run / "trajectory.tum", problems))
    record.path.push_back(pose.T_world_body.position);
  if (!record.path.empty()) record.entrance = record.path.front();
  record.finds = finds_of(run / "objects.json");
  return record;
}

}  // namespace karst::cave_drawing
