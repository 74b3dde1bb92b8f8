#include "sdk/cave_drawing/unrolled_survey.h"

#include <algorithm>

namespace karst::cave_drawing {
namespace {

constexpr double kBetweenParts_m = 10;

class SurveyLayout {
 public:
  explicit SurveyLayout(const survey::Survey& survey)
      : survey_(survey), legs_at_(survey.stations.size()), going_(survey.stations.size()) {
    out_.s_m.resize(survey.stations.size());
    out_.legs.resize(survey.legs.size());
    for (std::uint32_t i = 0; i < survey.legs.size(); ++i) {
      const survey::Leg& leg = survey.legs[i];
      if (leg.surface || leg.from == leg.to) continue;
      legs_at_[leg.from].push_back(i);
      legs_at_[leg.to].push_back(i);
    }
  }

  UnrolledSurvey laid_out() {
    out_.first = first_station();
    double right_m = part_from(out_.first).right_m;
    for (std::uint32_t i = 0; i < survey_.stations.size(); ++i)
      if (!out_.s_m[i] && !legs_at_[i].empty()) {
        const Part part = part_from(i);
        const double by_m = right_m + kBetweenParts_m - part.left_m;
        shift(part, by_m);
        right_m = part.right_m + by_m;
      }
    for (std::uint32_t l = 0; l < survey_.legs.size(); ++l)
      if (survey_.legs[l].extend == survey::Extend::hide) out_.legs[l].reset();
    return std::move(out_);
  }

 private:
  /// How a station was reached.
  struct Going {
    double direction = 1;
    survey::Extend extend = survey::Extend::normal;
  };

  /// What hangs together.
  struct Part {
    std::vector<std::uint32_t> stations, legs;
    double left_m = 0, right_m = 0;
  };

  void shift(const Part& part, double by_m) {
    for (const std::uint32_t s : part.stations) *out_.s_m[s] += by_m;
    for (const std::uint32_t l : part.legs) {
      out_.legs[l]->first += by_m;
      out_.legs[l]->second += by_m;
    }
  }

  std::uint32_t first_station() const {
    std::optional<std::uint32_t> fixed, any;
    for (std::uint32_t i = 0; i < survey_.stations.size(); ++i) {
      if (legs_at_[i].empty()) continue;
      if (survey_.stations[i].entrance) return i;
      if (!fixed && survey_.stations[i].fixed) fixed = i;
      if (!any) any = i;
    }
    return fixed ? *fixed : any.value_or(0);
  }

  Going after(const Going& before, const survey::Leg& leg, bool backwards) const {
    using enum survey::Extend;
    double direction = before.direction;
    if (leg.extend == right) direction = backwards ? -1 : 1;
    if (leg.extend == left) direction = backwards ? 1 : -1;
    // `extend reverse` holds for the legs that follow: only the first of them turns.
    if (leg.extend == reverse && before.extend != reverse) direction = -before.direction;
    return {direction, leg.extend};
  }

  /// Lays a part out with its root at zero.
  Part part_from(std::uint32_t root) {
    Part part;
    part.stations = {root};
    out_.s_m[root] = 0;
    for (std::size_t i = 0; i < part.stations.size(); ++i)
      for (const std::uint32_t l : legs_at_[part.stations[i]]) {
        const survey::Leg& leg = survey_.legs[l];
        if (leg.extend == survey::Extend::ignore || done(l)) continue;
        const std::uint32_t at = part.stations[i], other = leg.from == at ? leg.to : leg.from;
        const Going going = after(going_[at], leg, leg.to == at);
        const core::Vec3 d = survey_.stations[other].position_m - survey_.stations[at].position_m;
        const double across = leg.extend == survey::Extend::vertical ? 0 : d.head<2>().norm();
        const double from = *out_.s_m[at], to = from + going.direction * across;
        out_.legs[l] = leg.from == at ? std::pair(from, to) : std::pair(to, from);
        part.legs.push_back(l);
        part.left_m = std::min(part.left_m, to);
        part.right_m = std::max(part.right_m, to);
        if (out_.s_m[other]) continue;  // a loop ends here
        out_.s_m[other] = to;
        going_[other] = going;
        part.stations.push_back(other);
      }
    return part;
  }

  bool done(std::uint32_t leg) const { return out_.legs[leg].has_value(); }

  const survey::Survey& survey_;
  std::vector<std::vector<std::uint32_t>> legs_at_;
  std::vector<Going> going_;
  UnrolledSurvey out_;
};

}  // namespace

UnrolledSurvey unrolled_survey(const survey::Survey& survey) { return SurveyLayout(survey).laid_out(); }

}  // namespace karst::cave_drawing
