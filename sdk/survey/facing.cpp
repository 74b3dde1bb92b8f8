#include "sdk/survey/facing.h"

#include <optional>
#include <vector>

namespace karst::survey {
namespace {

constexpr double kSteep = 0.1;  // level part of a direction below which it tells no facing: 84 degrees

/// Level and of unit length; none for what is vertical.
std::optional<core::Vec3> level(const core::Vec3& vector) {
  const core::Vec3 flat(vector.x(), vector.y(), 0);
  if (flat.norm() <= kSteep * vector.norm() || flat.norm() < 1e-6) return std::nullopt;
  return flat.normalized();
}

/// Between what led to a place and what leads on; none if both are vertical or missing.
std::optional<core::Vec3> between(const std::optional<core::Vec3>& in, const std::optional<core::Vec3>& out) {
  if (!in || !out) return in ? in : out;
  const core::Vec3 sum = *in + *out;
  return sum.norm() < 0.1 ? *in : sum.normalized();  // a hairpin: as it came
}

/// Fills gaps from the direction before, and at the beginning from the first one.
void fill(std::vector<std::optional<core::Vec3>>& facings) {
  for (std::size_t i = 1; i < facings.size(); ++i)
    if (!facings[i]) facings[i] = facings[i - 1];
  for (std::size_t i = facings.size(); i-- > 1;)
    if (!facings[i - 1]) facings[i - 1] = facings[i];
}

class Facings {
 public:
  explicit Facings(Survey& survey) : survey_(survey) {}

  void set() {
    for (std::size_t begin = 0, end = 0; begin < survey_.sections.size(); begin = end) {
      while (end < survey_.sections.size() && survey_.sections[end].run == survey_.sections[begin].run) ++end;
      std::vector<std::optional<core::Vec3>> facings;
      for (std::size_t i = begin; i < end; ++i)
        facings.push_back(between(leading(i, begin, false), leading(i, end - 1, true)));
      fill(facings);
      for (std::size_t i = begin; i < end; ++i)
        survey_.sections[i].facing = facings[i - begin].value_or(core::Vec3::UnitY());
    }
  }

 private:
  const core::Vec3& at(std::uint32_t station) const { return survey_.stations[station].position_m; }

  /// Of a leg in the direction in which the run passes it.
  std::optional<core::Vec3> direction(std::size_t leg, std::uint32_t run) const {
    if (leg >= survey_.legs.size() || survey_.legs[leg].run != run) return std::nullopt;
    return level(at(survey_.legs[leg].to) - at(survey_.legs[leg].from));
  }

  /// What leads to the station of a section, or on from it: of the run's legs, else of its sections.
  std::optional<core::Vec3> leading(std::size_t i, std::size_t last, bool on) const {
    const Section& s = survey_.sections[i];
    if (s.leg) {
      const bool at_end = survey_.legs[*s.leg].to == s.station;
      if (at_end != on) return direction(*s.leg, survey_.legs[*s.leg].run);
      return direction(on ? *s.leg + 1 : *s.leg - 1, survey_.legs[*s.leg].run);
    }
    if (i == last) return std::nullopt;
    const Section& other = survey_.sections[on ? i + 1 : i - 1];
    const core::Vec3 step = at(other.station) - at(s.station);
    return level(on ? step : core::Vec3(-step));
  }

  Survey& survey_;
};

}  // namespace

void set_facings(Survey& survey) { Facings(survey).set(); }

}  // namespace karst::survey
