// Goes for what a survey lacks: frontiers outside of the surveyed passages first, by the volume they show for
// the time they take. While there are none, it flies through surveyed passages towards the places where the
// survey ends, and does not stop to fill them in. Without a survey, all there is lies outside of it.
#include <karst/expected_gain.h>
#include <karst/open_frontiers.h>
#include <karst/ranking.h>
#include <karst/survey.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "survey_ways.h"

namespace {

using beyond_survey::SurveyWays;
using Candidate = karst::OpenFrontiers::Candidate;

constexpr double kStop_s = 1.5;        // what a goal takes besides the flight to it
constexpr double kTurn_s = 3.0;        // what flying straight back takes; less for smaller turns
constexpr double kCruise = 0.75;       // mean speed of a flight, as a share of the greatest
constexpr double kUnknownWay = 1.5;    // a metre that is not in the map yet takes so much longer: short goals
constexpr double kLargest_m3 = 40;     // more expected volume counts as this
constexpr double kKeep = 0.3;          // share by which another goal must be better than the one under way
constexpr double kLookedAt_m = 4;      // a lead is spent once the vehicle was so near to it,
constexpr double kFrontierNear_m = 6;  // or once it is in the map and no frontier is so near

class BeyondSurvey : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    open_.parameters(p);
    gain_.parameters(p);
    p.add("margin", margin_m_, "m", 0, 20,
          "a frontier counts as beyond the survey if its centre is so far outside of the passages");
    p.add("goals", goals_, 1, 32, "how many goals to propose, best first");
  }

  karst::Decision decide(const karst::Request& request) override {
    const std::optional<karst::SurveyView> survey = karst::SurveyView::of(request.host());
    if (survey) note_leads(request, *survey);
    const std::vector<Candidate> open = open_.of(request);
    if (open.empty()) return open_.none_left(request);
    open_.found_some();
    std::vector<Candidate> beyond = open, surveyed;
    if (survey) {
      const std::vector<bool> outside = are_outside(*survey, open);
      beyond.clear();
      for (std::size_t i = 0; i < open.size(); ++i) (outside[i] ? beyond : surveyed).push_back(open[i]);
    }
    std::vector<karst::Goal> goals = by_gain(request, beyond, survey ? " beyond the survey" : "");
    const auto most = static_cast<std::size_t>(goals_);
    karst::keep_best(goals, most);
    std::vector<karst::Goal> later = by_way(request, surveyed);
    karst::keep_best(later, most - goals.size());
    goals.insert(goals.end(), later.begin(), later.end());
    return karst::Decision::fly(std::move(goals));
  }

  void on_event(const karst::Event& event) override { open_.on_event(event); }

 private:
  std::vector<bool> are_outside(const karst::SurveyView& survey, const std::vector<Candidate>& open) const {
    std::vector<karst::Vec3> places;
    for (const Candidate& c : open) places.push_back(c.frontier->centroid);
    std::vector<bool> outside;
    for (const double distance_m : survey.distances(places)) outside.push_back(distance_m > margin_m_);
    return outside;
  }

  /// Ways lead to the leads that may still show more.
  void note_leads(const karst::Request& request, const karst::SurveyView& survey) {
    if (!ways_) ways_.emplace(survey);
    const std::vector<karst::SurveyLead>& leads = ways_->leads();
    spent_.resize(leads.size());
    std::vector<karst::Vec3> places;
    for (const karst::SurveyLead& l : leads) places.emplace_back(l.position);
    const std::vector<karst::Cell> cells = request.map.cells(places);
    std::vector<bool> open(leads.size());
    for (std::size_t i = 0; i < leads.size(); ++i) {
      if (karst::distance(places[i], request.position()) < kLookedAt_m) spent_[i] = true;
      const bool frontier_near = std::any_of(
          request.frontiers.begin(), request.frontiers.end(),
          [&](const karst::Frontier& f) { return karst::distance(f.centroid, places[i]) < kFrontierNear_m; });
      open[i] = !spent_[i] && (cells[i] == karst::Cell::unknown || frontier_near);
    }
    ways_->lead_to(open);
  }

  static double time_s(const karst::Request& request, const Candidate& c, double more_m) {
    return kStop_s +
           (c.frontier->path_length_m + c.revisit_penalty_m + more_m) / (kCruise * request.max_speed_mps) +
           kTurn_s * karst::turn_fraction(request, *c.frontier);
  }

  std::vector<double> volumes_m3(const karst::Request& request, const std::vector<Candidate>& candidates) {
    std::vector<const karst::Frontier*> frontiers;
    for (const Candidate& c : candidates) frontiers.push_back(c.frontier);
    std::vector<double> out = gain_.volumes_m3(request, frontiers);
    for (double& v : out) v = std::min(v, kLargest_m3);
    return out;
  }

  /// Scores are m^3/s.
  std::vector<karst::Goal> by_gain(const karst::Request& request, const std::vector<Candidate>& candidates,
                                   const char* where) {
    const std::vector<double> shown_m3 = volumes_m3(request, candidates);
    std::vector<karst::Goal> goals;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const karst::Frontier& f = *candidates[i].frontier;
      const double t = time_s(request, candidates[i], 0);
      const double keep = karst::under_way(request, f) ? 1 + kKeep : 1;
      char why[120];
      std::snprintf(why, sizeof why, "%.1f m^3%s to be seen in %.1f s, %.1f m away", shown_m3[i], where, t,
                    f.path_length_m);
      goals.push_back(karst::goal_at(f, keep * shown_m3[i] / t, why));
    }
    return goals;
  }

  /// Of frontiers in surveyed passages, so there is a survey. Scores are minus the seconds to the next lead;
  /// if no lead is left, minus the seconds for a cubic metre.
  std::vector<karst::Goal> by_way(const karst::Request& request, const std::vector<Candidate>& candidates) {
    std::vector<karst::Goal> goals;
    std::vector<Candidate> elsewhere;
    for (const Candidate& c : candidates) {
      const karst::Frontier& f = *c.frontier;
      const double on_m = ways_->way_m(f.centroid);
      if (!std::isfinite(on_m)) {
        elsewhere.push_back(c);
        continue;
      }
      const double keep = karst::under_way(request, f) ? 1 + kKeep : 1;
      char why[120];
      std::snprintf(why, sizeof why, "%.1f m away, through surveyed passages to a lead %.1f m further on",
                    f.path_length_m, on_m);
      goals.push_back(karst::goal_at(f, -time_s(request, c, kUnknownWay * on_m) / keep, why));
    }
    if (!goals.empty()) return goals;
    const std::vector<double> shown_m3 = volumes_m3(request, elsewhere);
    for (std::size_t i = 0; i < elsewhere.size(); ++i) {
      const karst::Frontier& f = *elsewhere[i].frontier;
      const double t = time_s(request, elsewhere[i], 0);
      const double keep = karst::under_way(request, f) ? 1 + kKeep : 1;
      char why[120];
      std::snprintf(why, sizeof why, "%.1f m^3 to be seen in %.1f s in surveyed passages: no lead is left",
                    shown_m3[i], t);
      goals.push_back(karst::goal_at(f, -t / (keep * std::max(shown_m3[i], 0.1)), why));
    }
    return goals;
  }

  karst::OpenFrontiers open_;
  karst::ExpectedGain gain_;
  std::optional<SurveyWays> ways_;
  std::vector<bool> spent_;  // of the leads
  double margin_m_ = 2.0;
  int goals_ = 8;
};

}  // namespace

KARST_POLICY(BeyondSurvey, "beyond_survey", "1.1.0",
             "Explores what a survey lacks, and flies through what it knows to where it ends.")
