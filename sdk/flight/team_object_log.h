// team.jsonl's lines about objects of interest: when a robot told of one, and when the base knew.
#pragma once
#include "sdk/flight/team_log.h"

namespace karst::flight {

class TeamObjectLog {
 public:
  /// To be called after every exchange: a line `object` for what `robot` told since, and a line
  /// `object_known` for what has come to the base.
  void robot(core::TimeNs now, const core::TeamNode& robot, TeamLog& log);
  void base(core::TimeNs now, const core::TeamNode& base, TeamLog& log);

 private:
  void news(core::TimeNs now, const char* kind, const core::ReportedObjects& objects, core::RobotId of,
            core::ReportedObjects& noted, TeamLog& log);

  core::ReportedObjects reported_, known_;  // as last noted
};

}  // namespace karst::flight
