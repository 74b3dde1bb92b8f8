// The frontier that shows the most unknown space for the time the flight to it takes.
#include <karst/expected_gain.h>
#include <karst/ranking.h>

#include <algorithm>
#include <cstdio>

namespace {

class InformationGain : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    open_.parameters(p);
    gain_.parameters(p);
    p.add("most_volume", most_volume_m3_, "m^3", 0.1, 10000, "more expected volume counts as this");
    p.add("least_volume", least_volume_m3_, "m^3", 0, 100,
          "frontiers that show less are left until nothing else is to be had");
    p.add("stop_time", stop_s_, "s", 0.1, 60, "what a goal takes besides the flight to it");
    p.add("turn_time", turn_s_, "s", 0, 60, "what flying straight back costs; less for smaller turns");
    p.add("cruise", cruise_, "", 0.1, 1, "mean speed of a flight, as a share of the greatest");
    p.add("keep", keep_, "", 0, 10, "share by which another goal must be better than the one under way");
    p.add("goals", goals_, 1, 32, "how many goals to propose, best first");
  }

  karst::Decision decide(const karst::Request& request) override {
    std::vector<karst::OpenFrontiers::Candidate> open = open_.of(request);
    if (open.empty()) return open_.none_left(request);
    open_.found_some();
    std::sort(open.begin(), open.end(), [](const auto& a, const auto& b) {
      return a.frontier->path_length_m != b.frontier->path_length_m
                 ? a.frontier->path_length_m < b.frontier->path_length_m
                 : a.frontier->id < b.frontier->id;
    });
    return karst::Decision::fly(ranked(request, open));
  }

  void on_event(const karst::Event& event) override { open_.on_event(event); }

 private:
  static constexpr std::size_t batch = 8;

  double time_s(const karst::Request& request, const karst::OpenFrontiers::Candidate& c) const {
    const double length_m = c.frontier->path_length_m + c.reluctance_m;
    return stop_s_ + length_m / (cruise_ * request.max_speed_mps) +
           turn_s_ * karst::turn_share(request, *c.frontier);
  }

  /// From the nearest on, and no farther than something could still be better: no frontier is worth more than
  /// most_volume over the time of a flight straight on.
  std::vector<karst::Goal> ranked(const karst::Request& request,
                                  const std::vector<karst::OpenFrontiers::Candidate>& open) {
    std::vector<karst::Goal> goals;
    double best = 0;
    for (std::size_t begin = 0; begin < open.size(); begin += batch) {
      const double soonest_s =
          stop_s_ + open[begin].frontier->path_length_m / (cruise_ * request.max_speed_mps);
      if (most_volume_m3_ / soonest_s * (1 + keep_) < best || request.should_stop()) break;
      std::vector<const karst::Frontier*> some;
      for (std::size_t i = begin; i < std::min(begin + batch, open.size()); ++i)
        some.push_back(open[i].frontier);
      const std::vector<double> volumes_m3 = gain_.volumes_m3(request, some);
      for (std::size_t i = 0; i < some.size(); ++i) {
        goals.push_back(goal(request, open[begin + i], volumes_m3[i]));
        best = std::max(best, goals.back().score);
      }
    }
    karst::keep_best(goals, static_cast<std::size_t>(goals_));
    return goals;
  }

  karst::Goal goal(const karst::Request& request, const karst::OpenFrontiers::Candidate& c,
                   double volume_m3) const {
    const double t = time_s(request, c);
    double score = std::min(volume_m3, most_volume_m3_) / t;
    if (volume_m3 < least_volume_m3_) score *= 1e-3;
    if (karst::under_way(request, *c.frontier)) score *= 1 + keep_;
    char why[120];
    std::snprintf(why, sizeof why, "%.1f m^3 to be seen in %.1f s, %.1f m away", volume_m3, t,
                  c.frontier->path_length_m);
    return karst::goal_at(*c.frontier, score, why);
  }

  karst::OpenFrontiers open_;
  karst::ExpectedGain gain_;
  double most_volume_m3_ = 40.0;
  double least_volume_m3_ = 0.3;
  double stop_s_ = 1.5;
  double turn_s_ = 3.0;
  double cruise_ = 0.75;
  double keep_ = 0.3;
  int goals_ = 8;
};

}  // namespace

KARST_POLICY(InformationGain, "information_gain", "1.0.0",
             "Flies to the frontier that shows the most unknown space for the time it takes.")
