// Chooses the frontier with the most expected information gain per second of flight to it.
#include <karst/diminishing_gain.h>
#include <karst/expected_gain.h>
#include <karst/ranking.h>
#include <karst/straight_path.h>

#include <algorithm>
#include <cstdio>

namespace {

class InformationGain : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    open_.parameters(p);
    gain_.parameters(p);
    diminishing_.parameters(p);
    p.add("max_volume", max_volume_m3_, "m^3", 0.1, 10000, "more expected volume counts as this");
    p.add("min_volume", min_volume_m3_, "m^3", 0, 100,
          "frontiers that show less are left until nothing else is to be had");
    p.add("stop_time", stop_s_, "s", 0.1, 60, "what a goal takes besides the flight to it");
    p.add("turn_time", turn_s_, "s", 0, 60, "what flying straight back costs; less for smaller turns");
    p.add("cruise", cruise_, "", 0.1, 1, "mean speed of a flight, as a share of the greatest");
    p.add("passing", passing_m_, "m", 0, 20,
          "what lies behind openings this near to a straight way is seen on the way");
    p.add("keep", keep_, "", 0, 10, "share by which another goal must be better than the one under way");
    p.add("goals", goals_, 1, 32, "how many goals to propose, best first");
  }

  karst::Decision decide(const karst::Request& request) override {
    const std::vector<karst::OpenFrontiers::Candidate> open = open_.of(request);
    if (open.empty()) return open_.none_left(request);
    open_.found_some();
    const Ranked best = ranked(request, candidates_of(request, open));
    if (diminishing_.over(request, best.most_m3))
      return karst::Decision::explored("what is left shows too little to be cave");
    return karst::Decision::fly(best.goals);
  }

  void on_event(const karst::Event& event) override { open_.on_event(event); }

 private:
  static constexpr std::size_t batch = 4;

  struct Candidate {
    const karst::Frontier* frontier;
    double time_s, passed_m3;
    double most_m3;     // upper bound of what it shows
    double best_score;  // of its score
  };
  struct Ranked {
    std::vector<karst::Goal> goals;
    double most_m3 = 0;  // that any candidate may show
  };

  /// Sorted by the upper bound of the score, highest first.
  std::vector<Candidate> candidates_of(const karst::Request& request,
                                       const std::vector<karst::OpenFrontiers::Candidate>& open) {
    const bool sees_what_it_passes = karst::sees_all_around(request);
    std::vector<Candidate> out;
    for (const auto& [f, revisit_penalty_m] : open) {
      const double t = stop_s_ + (f->path_length_m + revisit_penalty_m) / (cruise_ * request.max_speed_mps) +
                       turn_s_ * karst::turn_fraction(request, *f);
      const double passed = sees_what_it_passes ? passed_m3(request, *f) : 0;
      const double most = std::min(gain_.most_m3(request, *f), max_volume_m3_) + passed;
      const double keep = karst::under_way(request, *f) ? 1 + keep_ : 1;
      out.push_back({f, t, passed, most, keep * most / t});
    }
    std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return a.best_score != b.best_score ? a.best_score > b.best_score : a.frontier->id < b.frontier->id;
    });
    return out;
  }

  /// Volume behind the openings that the flight to the viewpoint passes before those in view from there.
  double passed_m3(const karst::Request& request, const karst::Frontier& f) const {
    const karst::StraightPath path(request.position(), f.viewpoint, f.path_length_m);
    double sum_m3 = 0;
    for (const karst::Frontier& other : request.frontiers)
      if (other.id != f.id && path.passes(other.centroid, passing_m_, gain_.range_m))
        sum_m3 += std::min(gain_.behind_m3(request, other), max_volume_m3_);
    return sum_m3;
  }

  /// Gain queries are expensive: stops once no candidate's upper bound exceeds the best score so far.
  Ranked ranked(const karst::Request& request, const std::vector<Candidate>& candidates) {
    Ranked out;
    double best = 0;
    std::size_t begin = 0;
    for (; begin < candidates.size(); begin += batch) {
      if (candidates[begin].best_score < best || request.should_stop()) break;
      const std::size_t end = std::min(begin + batch, candidates.size());
      std::vector<const karst::Frontier*> some;
      for (std::size_t i = begin; i < end; ++i) some.push_back(candidates[i].frontier);
      const std::vector<double> volumes_m3 = gain_.volumes_m3(request, some);
      for (std::size_t i = begin; i < end; ++i) {
        const double shown_m3 = std::min(volumes_m3[i - begin], max_volume_m3_) + candidates[i].passed_m3;
        out.most_m3 = std::max(out.most_m3, shown_m3);
        out.goals.push_back(goal(request, candidates[i], shown_m3));
        best = std::max(best, out.goals.back().score);
      }
    }
    for (; begin < candidates.size(); ++begin) out.most_m3 = std::max(out.most_m3, candidates[begin].most_m3);
    karst::keep_best(out.goals, static_cast<std::size_t>(goals_));
    return out;
  }

  karst::Goal goal(const karst::Request& request, const Candidate& c, double shown_m3) const {
    double score = shown_m3 / c.time_s;
    if (shown_m3 < min_volume_m3_) score *= 1e-3;
    if (karst::under_way(request, *c.frontier)) score *= 1 + keep_;
    char why[120];
    std::snprintf(why, sizeof why, "%.1f m^3 to be seen in %.1f s, %.1f of them in passing, %.1f m away",
                  shown_m3, c.time_s, c.passed_m3, c.frontier->path_length_m);
    return karst::goal_at(*c.frontier, score, why);
  }

  karst::OpenFrontiers open_;
  karst::ExpectedGain gain_;
  karst::DiminishingGain diminishing_;
  double max_volume_m3_ = 200.0;
  double min_volume_m3_ = 0.3;
  double stop_s_ = 1.5;
  double turn_s_ = 3.0;
  double cruise_ = 0.75;
  double keep_ = 0.3;
  double passing_m_ = 3.0;
  int goals_ = 8;
};

}  // namespace

KARST_POLICY(InformationGain, "information_gain", "1.3.0",
             "Flies to the frontier that shows the most unknown space for the time it takes.")
