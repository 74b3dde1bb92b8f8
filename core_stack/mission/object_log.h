// team.jsonl's lines about objects of interest: when a robot told of one, and when the base knew.
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "core_stack/mission/team_log.h"

namespace karst::core {

class ObjectLog {
 public:
  /// To be called after every exchange: a line `object` for what `robot` told since, and a line
  /// `object_known` for what has come to the base.
  void robot(TimeNs now, const Teammate& robot, TeamLog& log);
  void base(TimeNs now, const Teammate& base, TeamLog& log);

 private:
  void news(TimeNs now, const char* kind, const ToldObjects& objects, RobotId of, ToldObjects& noted,
            TeamLog& log);

  ToldObjects told_, known_;  // as last noted
};

/// Objects of all finders together, as files list them.
nlohmann::json list_of(const std::vector<TeamObject>& objects);

}  // namespace karst::core
