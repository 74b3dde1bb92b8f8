// The survey as a graph: how far it is along its legs from anywhere to the leads that are still worth it.
#pragma once
#include <karst/survey.h>

#include <cstdint>
#include <vector>

namespace beyond_survey {

class SurveyWays {
 public:
  explicit SurveyWays(const karst::SurveyView& survey) : legs_(survey.legs()), leads_(survey.leads()) {}

  const std::vector<karst::SurveyLead>& leads() const { return leads_; }
  /// Ways lead to those of the leads for which `open` holds; to the ones that the surveyor marked, if any of
  /// them is open.
  void lead_to(const std::vector<bool>& open);
  /// From a point to the nearest leg, and along the legs to the nearest such lead, m; +infinity if there is
  /// none.
  double way_m(const karst::Vec3& from) const;

 private:
  std::vector<karst::SurveyLeg> legs_;
  std::vector<karst::SurveyLead> leads_;
  std::vector<double> to_lead_m_;  // by station
};

}  // namespace beyond_survey
