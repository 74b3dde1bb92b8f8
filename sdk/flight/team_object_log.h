// team.jsonl's lines about objects of interest: when a robot reported one, and when the base received it.
#pragma once
#include "sdk/flight/team_log.h"

namespace karst::flight {

class TeamObjectLog {
 public:
  /// To be called after every exchange: writes a line `object` for each object that `robot` has reported
  /// since, and a line `object_known` for each that the base has received.
  void robot(core::TimeNs now, const core::TeamNode& robot, TeamLog& log);
  void base(core::TimeNs now, const core::TeamNode& base, TeamLog& log);

 private:
  void news(core::TimeNs now, const char* kind, const core::ReportedObjects& objects, core::RobotId of,
            core::ReportedObjects& noted, TeamLog& log);

  core::ReportedObjects reported_, known_;  // as last logged
};

}  // namespace karst::flight
