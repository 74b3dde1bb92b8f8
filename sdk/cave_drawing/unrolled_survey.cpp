#include "sdk/cave_drawing/unrolled_survey.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sdk/cave_drawing/passage_strips.h"
#include "sdk/cave_drawing/strip_places.h"

namespace karst::cave_drawing {
namespace {

constexpr double kBetweenParts_m = 10;
constexpr double kCell_m = 0.5;
constexpr double kSame_m = 0.5;                     // places nearer than that are one
constexpr int kHallColumns = 6, kShiftColumns = 8;  // 3 m in which strips overlap where they branch off; 4 m
constexpr double kLeastHeight_m = 0.5;              // above and below a station

int cell(double v) { return static_cast<int>(std::floor(v / kCell_m + 1e-9)); }

class SurveyLayout {
 public:
  explicit SurveyLayout(const survey::Survey& survey)
      : survey_(survey), legs_at_(survey.stations.size()), going_(survey.stations.size()) {
    out_.s_m.resize(survey.stations.size());
    out_.legs.resize(survey.legs.size());
    up_m_.assign(survey.stations.size(), kLeastHeight_m);
    down_m_ = up_m_;
    for (const survey::Section& s : survey.sections) {
      up_m_[s.station] = std::max(up_m_[s.station], s.dimensions.up_m.value_or(0));
      down_m_[s.station] = std::max(down_m_[s.station], s.dimensions.down_m.value_or(0));
    }
    for (std::uint32_t i = 0; i < survey.legs.size(); ++i) {
      const survey::Leg& leg = survey.legs[i];
      if (leg.surface || leg.from == leg.to) continue;
      legs_at_[leg.from].push_back(i);
      legs_at_[leg.to].push_back(i);
    }
  }

  UnrolledSurvey laid_out() {
    out_.first = first_station();
    const Part main = part_from(out_.first);
    shift(main, 0);
    double right_m = main.right_m;
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
    std::vector<StationTwice> twice;
    double left_m = 0, right_m = 0;
  };

  void shift(const Part& part, double by_m) {
    for (const std::uint32_t s : part.stations) *out_.s_m[s] += by_m;
    for (const std::uint32_t l : part.legs) {
      out_.legs[l]->first += by_m;
      out_.legs[l]->second += by_m;
    }
    for (StationTwice t : part.twice) {
      t.s_m += by_m;
      t.again_s_m += by_m;
      out_.twice.push_back(t);
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
    const std::vector<std::uint32_t> stations = connected_to(root);
    for (const std::uint32_t s : stations)
      for (const std::uint32_t l : legs_at_[s])
        if (survey_.legs[l].extend != survey::Extend::normal) return extended_part(root);
    return part_of_strips(stations);
  }

  std::vector<std::uint32_t> connected_to(std::uint32_t root) const {
    std::vector<std::uint32_t> stations{root};
    std::set<std::uint32_t> seen{root};
    for (std::size_t i = 0; i < stations.size(); ++i)
      for (const std::uint32_t l : legs_at_[stations[i]])
        for (const std::uint32_t other : {survey_.legs[l].from, survey_.legs[l].to})
          if (seen.insert(other).second) stations.push_back(other);
    return stations;
  }

  /// What a strip covers: the passage's height at both ends of its legs, and a metre at least.
  ProfileCells cells_of_strip(const std::vector<std::uint32_t>& strip, const std::vector<double>& s_m) const {
    ProfileCells cells;
    const auto z_of = [&](std::uint32_t station) { return survey_.stations[station].position_m.z(); };
    for (std::size_t i = 0; i + 1 < strip.size(); ++i) {
      const int first = cell(s_m[i]), last = cell(s_m[i + 1]);
      const double low_m =
          std::min(z_of(strip[i]) - down_m_[strip[i]], z_of(strip[i + 1]) - down_m_[strip[i + 1]]);
      const double high_m =
          std::max(z_of(strip[i]) + up_m_[strip[i]], z_of(strip[i + 1]) + up_m_[strip[i + 1]]);
      for (int x = first; x <= last; ++x) cells[x].push_back({cell(low_m), cell(high_m)});
    }
    return cells;
  }

  /// The longest way to the right, and each side passage where it has room.
  Part part_of_strips(const std::vector<std::uint32_t>& stations) {
    std::map<std::uint32_t, std::uint32_t> local;
    for (std::uint32_t i = 0; i < stations.size(); ++i) local[stations[i]] = i;
    PassageLines lines;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> legs_between;
    for (const std::uint32_t s : stations) {
      PassagePoint& point = lines.points.emplace_back();
      point.middle = survey_.stations[s].position_m;
      std::set<std::uint32_t> next;
      for (const std::uint32_t l : legs_at_[s]) {
        const survey::Leg& leg = survey_.legs[l];
        next.insert(local.at(leg.from == s ? leg.to : leg.from));
        if (leg.from == s) legs_between[std::minmax(leg.from, leg.to)].push_back(l);
      }
      point.next.assign(next.begin(), next.end());
    }
    Part part;
    part.stations = stations;
    ProfileCells drawn;
    for (const PassageStrip& strip : passage_strips(lines)) {
      std::vector<std::uint32_t> way;
      std::vector<double> along{0};
      for (const std::uint32_t p : strip.points) {
        if (!way.empty())
          along.push_back(along.back() +
                          (survey_.stations[stations[p]].position_m - survey_.stations[way.back()].position_m)
                              .head<2>()
                              .norm());
        way.push_back(stations[p]);
      }
      std::optional<double>& start = out_.s_m[way.front()];
      const bool is_first = drawn.empty();
      if (!start) start = 0;
      const double from_m = *start;
      const ProfileCells own = cells_of_strip(way, along);
      StripPlace place{cell(from_m), false};
      if (!is_first)
        place =
            place_for(drawn, own, cell(from_m), 1, kHallColumns, kShiftColumns, way.front() == stations[0]);
      const double origin_m = from_m + (place.column - cell(from_m)) * kCell_m;
      const auto s_drawn = [&](std::size_t i) {
        return place.to_left ? origin_m - along[i] : origin_m + along[i];
      };
      if (place.column != cell(from_m)) part.twice.push_back({way.front(), from_m, origin_m, true});
      for (std::size_t i = 0; i < way.size(); ++i) {
        std::optional<double>& at = out_.s_m[way[i]];
        if (!at) at = s_drawn(i);
        part.left_m = std::min(part.left_m, s_drawn(i));
        part.right_m = std::max(part.right_m, s_drawn(i));
        if (i == 0) continue;
        for (const std::uint32_t l : legs_between[std::minmax(way[i - 1], way[i])]) {
          const bool onwards = survey_.legs[l].from == way[i - 1];
          out_.legs[l] =
              onwards ? std::pair(s_drawn(i - 1), s_drawn(i)) : std::pair(s_drawn(i), s_drawn(i - 1));
          part.legs.push_back(l);
        }
      }
      if (const double there = *out_.s_m[way.back()]; std::abs(there - s_drawn(way.size() - 1)) > kSame_m)
        part.twice.push_back({way.back(), there, s_drawn(way.size() - 1), false});
      for (const auto& [x, runs] : own) {
        auto& at = drawn[place.of(x)];
        at.insert(at.end(), runs.begin(), runs.end());
      }
    }
    return part;
  }

  Part extended_part(std::uint32_t root) {
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
        if (out_.s_m[other]) {  // a loop ends here
          if (std::abs(*out_.s_m[other] - to) > kSame_m)
            part.twice.push_back({other, *out_.s_m[other], to, false});
          continue;
        }
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
  std::vector<double> up_m_, down_m_;  // by station
  UnrolledSurvey out_;
};

}  // namespace

UnrolledSurvey unrolled_survey(const survey::Survey& survey) { return SurveyLayout(survey).laid_out(); }

}  // namespace karst::cave_drawing
