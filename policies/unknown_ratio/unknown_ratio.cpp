// The frontier with the largest ratio of unknown to free cells in a bounded region (trial D of the paper).
#include <karst/ranking.h>

#include <algorithm>
#include <cstdio>
#include <map>

namespace {

class UnknownRatio : public karst::Policy, public karst::Restorable {
 public:
  UnknownRatio() {
    ranking_.path_weight = 0.5;
    ranking_.turn_cost_m = 3.0;
  }

  void parameters(karst::Parameters& p) override {
    p.add("half_edge", half_edge_m_, "m", 0.4, 10,
          "half the edge of the box around a frontier that is counted");
    p.add("ratio_worth", ratio_worth_m_, "m", 0, 1000, "worth of a ratio of one");
    p.add("max_ratio", max_ratio_, "", 0.1, 1000,
          "larger ratios count as this: niches in rock have the largest");
    ranking_.parameters(p);
  }

  karst::Decision decide(const karst::Request& request) override {
    const std::map<std::uint32_t, double> ratios = ratios_of(request);
    return ranking_.decide(request, [&](const karst::Frontier& f) {
      const double ratio = ratios.at(f.id);
      char why[120];
      std::snprintf(why, sizeof why, "%.2f unknown cells for each free one, %.1f m away", ratio,
                    f.path_length_m);
      return karst::Merit{ratio_worth_m_ * std::min(ratio, max_ratio_), why};
    });
  }

  void on_event(const karst::Event& event) override { ranking_.on_event(event); }
  void memory(karst::Memory& m) override { ranking_.memory(m); }

 private:
  /// The ratio of every reachable frontier, by id, from one batched query.
  std::map<std::uint32_t, double> ratios_of(const karst::Request& request) const {
    std::vector<std::uint32_t> ids;
    std::vector<karst::Box> boxes;
    for (const karst::Frontier& f : request.frontiers) {
      if (!f.reachable()) continue;
      ids.push_back(f.id);
      boxes.push_back(karst::box_around(f.centroid, half_edge_m_));
    }
    const std::vector<karst_cell_counts_t> counts = request.map.counts(boxes);
    std::map<std::uint32_t, double> out;
    for (std::size_t i = 0; i < ids.size(); ++i)
      out[ids[i]] = static_cast<double>(counts[i].unknown) /
                    static_cast<double>(std::max<std::uint64_t>(counts[i].free, 1));
    return out;
  }

  double half_edge_m_ = 3.0;
  double ratio_worth_m_ = 6.0;
  double max_ratio_ = 4.0;
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(UnknownRatio, "unknown_ratio", "1.0.0",
             "Flies to the frontier with the most unknown cells for each free one around it.")
