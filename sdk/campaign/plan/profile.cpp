#include "sdk/campaign/plan/profile.h"

#include <algorithm>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::campaign {

const std::vector<Profile>& profiles() {
  static const std::vector<Profile> all = {
      {"full", "every setting as `karst fly` has it", {}},
      {"campaign",
       "poses come from a sensor instead of LOAM, and the LiDAR turns five times a second, not ten",
       {{"simulator.pose.fitted", "always"},
        {"localization.source", "pose_sensor"},
        {"simulator.lidar.rate", "5 Hz"}}},
  };
  return all;
}

const Profile& profile(const std::string& name) {
  const auto found =
      std::find_if(profiles().begin(), profiles().end(), [&](const Profile& p) { return p.name == name; });
  if (found != profiles().end()) return *found;
  std::vector<std::string> names;
  for (const Profile& p : profiles()) names.push_back(p.name);
  const std::string near = core::nearest_name(name, names);
  throw core::InputError("profile", name,
                         "no such profile" + (near.empty() ? "" : "; did you mean " + near + "?"));
}

}  // namespace karst::campaign
