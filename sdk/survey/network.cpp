#include "sdk/survey/network.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"
#include "sdk/survey/place_sets.h"

namespace karst::survey {
namespace {

constexpr double kSameFix_m = 0.01;   // also far less than a degree's last printed digit
constexpr double kSamePlace_m = 0.5;  // a leg so short may tie two names of one place

class Builder {
 public:
  explicit Builder(Readings& readings)
      : readings_(readings),
        same_(readings.stations.size()),
        tied_(readings.stations.size()),
        part_legs_(readings.stations.size(), 0) {}

  Network build() {
    for (const Equate& e : readings_.equates) same_.unite(e.a, e.b);
    find_touched();
    for (std::uint32_t i = 0; i < readings_.legs.size(); ++i)
      if (ties(readings_.legs[i])) tied_.unite(root(readings_.legs[i].from), root(readings_.legs[i].to));
    for (const Reading& r : readings_.legs)
      if (ties(r)) ++part_legs_[tied_.root(root(r.from))];
    choose_fixes();
    choose_parts();
    number_places();
    sort_readings();
    return std::move(network_);
  }

 private:
  std::uint32_t root(std::uint32_t station) { return same_.root(station); }
  bool is_leg(const Reading& r) { return !r.splay || (touched_[root(r.from)] && touched_[root(r.to)]); }
  bool ties(const Reading& r) {
    return is_leg(r) && r.style != Style::no_survey && root(r.from) != root(r.to);
  }
  bool kept(std::uint32_t station) { return kept_[tied_.root(root(station))]; }

  /// Places that a leg that is no splay, or a fix, leads to.
  void find_touched() {
    touched_.assign(readings_.stations.size(), false);
    for (const Reading& r : readings_.legs)
      if (!r.splay) touched_[root(r.from)] = touched_[root(r.to)] = true;
    for (const Fix& f : readings_.fixes) touched_[root(f.station)] = true;
  }

  void choose_fixes() {
    std::vector<std::uint32_t> fix_at(readings_.stations.size(), Network::kNone);
    for (std::uint32_t i = 0; i < readings_.fixes.size(); ++i) {
      const Fix& f = readings_.fixes[i];
      std::uint32_t& first = fix_at[root(f.station)];
      if (first == Network::kNone) {
        first = i;
        network_.fixes.push_back(i);
        continue;
      }
      const Fix& other = readings_.fixes[first];
      const bool same_system = f.system == other.system;
      const bool degrees = f.system == "lat-long" || f.system == "long-lat";
      const double level = std::hypot(f.x - other.x, f.y - other.y) * (degrees ? 1e5 : 1);
      if (same_system && level <= kSameFix_m && std::abs(f.z - other.z) <= kSameFix_m) continue;
      const std::string where =
          readings_.log.files[other.source.file] + ", line " + std::to_string(other.source.line);
      if (!f.sd_m && !other.sd_m)
        throw readings_.log.error(f.source, "the station " +
                                                core::printable(readings_.stations[f.station].name) +
                                                " is fixed elsewhere at " + where);
      readings_.log.note(f.source, "the station is fixed at " + where + " as well; this fix is left out");
    }
  }

  void choose_parts() {
    kept_.assign(readings_.stations.size(), false);
    for (const std::uint32_t i : network_.fixes) {
      const std::uint32_t part = tied_.root(root(readings_.fixes[i].station));
      if (part_legs_[part] > 0) kept_[part] = true;
    }
    const auto most = std::max_element(part_legs_.begin(), part_legs_.end());
    if (most == part_legs_.end() || *most == 0)
      throw core::InputError(readings_.log.files.front(), "", "holds no leg");
    if (std::find(kept_.begin(), kept_.end(), true) == kept_.end()) {
      kept_[static_cast<std::size_t>(most - part_legs_.begin())] = true;
      network_.fixes.clear();
      readings_.log.note({0, 0}, "no station of the survey is fixed: its first station is the origin");
    }
    std::vector<bool> told(readings_.stations.size(), false);
    for (const Reading& r : readings_.legs) {
      if (!ties(r) || kept(r.from)) continue;
      ++network_.left_out.legs;
      network_.left_out.legs_m += r.vector_m().norm();
      const std::uint32_t part = tied_.root(root(r.from));
      if (told[part]) continue;
      told[part] = true;
      ++network_.left_out.parts;
      readings_.log.note(r.source, core::counted(part_legs_[part], "leg") + " from here on " +
                                       (part_legs_[part] == 1 ? "is" : "are") +
                                       " tied to no fixed station: left out");
    }
    std::erase_if(network_.fixes, [&](std::uint32_t i) { return !kept(readings_.fixes[i].station); });
  }

  void number_places() {
    std::vector<std::uint32_t> of_root(readings_.stations.size(), Network::kNone);
    network_.place.assign(readings_.stations.size(), Network::kNone);
    for (std::uint32_t s = 0; s < readings_.stations.size(); ++s) {
      const std::uint32_t r = root(s);
      if (!kept(s) || (!touched_[r] && readings_.stations[s].anonymous)) continue;
      if (of_root[r] == Network::kNone) {
        of_root[r] = static_cast<std::uint32_t>(network_.stations.size());
        network_.stations.push_back(s);
      }
      network_.place[s] = of_root[r];
    }
  }

  void sort_readings() {
    std::size_t tying = 0;
    for (std::uint32_t i = 0; i < readings_.legs.size(); ++i) {
      const Reading& r = readings_.legs[i];
      const std::uint32_t from = network_.place[r.from], to = network_.place[r.to];
      if (!is_leg(r)) {
        add_splay(i, from, to);
      } else if (from == Network::kNone || to == Network::kNone) {
        if (r.style == Style::no_survey && (from != to))
          readings_.log.note(r.source, "an unmeasured leg to a station that nothing else ties: left out");
      } else if (from == to) {
        const double length_m = r.style == Style::no_survey ? 0 : r.vector_m().norm();
        if (length_m > kSamePlace_m && !r.duplicate)
          throw readings_.log.error(
              r.source,
              core::format_text("this leg of %.2f m contradicts an equate, which makes its ends ", length_m) +
                  core::printable(readings_.stations[r.from].name) + " and " +
                  core::printable(readings_.stations[r.to].name) + " one station");
        readings_.log.note(r.source,
                           core::format_text("a leg of %.2f m whose ends are equated: left out", length_m));
      } else {
        network_.legs.push_back(i);
        if (r.style != Style::no_survey) ++tying;
      }
    }
    // One part, in which the fixed places count as one.
    const std::size_t edges = tying + std::max<std::size_t>(network_.fixes.size(), 1);
    network_.loops = edges - std::min(edges, network_.stations.size());
  }

  void add_splay(std::uint32_t i, std::uint32_t from, std::uint32_t to) {
    const Reading& r = readings_.legs[i];
    const bool reversed = readings_.stations[r.from].anonymous || !touched_[root(r.from)];
    const std::uint32_t place = reversed ? to : from;
    const std::uint32_t station = reversed ? r.to : r.from;
    if (!touched_[root(station)])
      readings_.log.note(r.source, "a splay from a station that no leg leads to: left out");
    else if (place != Network::kNone && r.style != Style::no_survey)
      network_.splays.push_back({i, place, reversed});
  }

  Readings& readings_;
  PlaceSets same_, tied_;
  std::vector<std::size_t> part_legs_;
  std::vector<bool> touched_, kept_;
  Network network_;
};

}  // namespace

Network network_of(Readings& readings) { return Builder(readings).build(); }

}  // namespace karst::survey
