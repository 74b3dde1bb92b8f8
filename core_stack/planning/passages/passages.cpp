#include "core_stack/planning/passages/passages.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "core_stack/planning/passages/slice_graph.h"

namespace karst::core {
namespace {

struct Shares {
  double volume_m3 = 0, frontier_m2 = 0;
};

}  // namespace

class PassageMapBuilder {
 public:
  PassageMapBuilder(const VoxelMap& map, FreeParts space, Slices slices)
      : cell_m_(space.grid.cell_m), band_m_(kBandCubes * space.grid.cube_m()), slices_(std::move(slices)) {
    for (const Slice& s : slices_.slices)
      sections_.push_back(cross_section(map, space.parts[s.middle].middle, 0.5 * band_m_));
    groups_ = simplified(slices_.slices, sections_, band_m_);
    space.links = {};  // at() needs none
    out_.space_ = std::move(space);
  }

  PassageMap build() {
    end_of_group_.assign(groups_.size(), kNoPassage);
    passage_of_group_.assign(groups_.size(), kNoPassage);
    for (std::uint32_t g = 0; g < groups_.size(); ++g)
      if (groups_[g].next.size() >= 3) {
        const Shares shares = shares_of({&g, 1});
        end_of_group_[g] = add_end(g, PassageEnd::Kind::junction, shares);
      }
    for (const SliceChain& c : chains_of(groups_)) add_passage(c);
    order();
    place_slices();
    return std::move(out_);
  }

 private:
  const CrossSection& section_of(std::uint32_t group) const { return sections_[groups_[group].core]; }
  double from_start_m(std::uint32_t slice) const {
    return slices_.from_start_cubes[slices_.slices[slice].middle] * band_m_ / kBandCubes;
  }
  double volume_m3(std::uint64_t free_cells) const {
    return static_cast<double>(free_cells) * cell_m_ * cell_m_ * cell_m_;
  }
  Shares shares_of(std::span<const std::uint32_t> groups) const {
    std::uint64_t free_cells = 0, frontier_cells = 0;
    for (const std::uint32_t g : groups)
      for (const std::uint32_t s : groups_[g].slices) {
        free_cells += slices_.slices[s].free_cells;
        frontier_cells += slices_.slices[s].frontier_cells;
      }
    return {volume_m3(free_cells), static_cast<double>(frontier_cells) * cell_m_ * cell_m_};
  }

  std::uint32_t add_end(std::uint32_t group, PassageEnd::Kind kind, const Shares& shares) {
    PassageEnd end;
    end.position = section_of(group).center;
    end.from_start_m = from_start_m(groups_[group].core);
    end.width_m = section_of(group).width_m;
    end.height_m = section_of(group).height_m;
    end.volume_m3 = shares.volume_m3;
    end.frontier_m2 = shares.frontier_m2;
    end.kind = kind;
    out_.ends.push_back(end);
    return static_cast<std::uint32_t>(out_.ends.size() - 1);
  }

  /// The end of a passage whose last groups these are, the very last first.
  std::uint32_t add_last(std::span<const std::uint32_t> last) {
    const bool open = is_open_end(last, groups_, slices_.slices, out_.space_.grid);
    return add_end(last.front(), open ? PassageEnd::Kind::open_end : PassageEnd::Kind::dead_end,
                   shares_of(last));
  }

  void add_passage(const SliceChain& chain) {
    constexpr std::size_t kLast = 2;  // groups that show whether an end is open
    std::vector<std::uint32_t> groups = chain.groups;
    std::array<std::uint32_t, 2> ends{kNoPassage, kNoPassage};
    if (chain.is_ring) {
      const auto nearest = std::min_element(groups.begin(), groups.end(), [&](auto a, auto b) {
        return from_start_m(groups_[a].core) < from_start_m(groups_[b].core);
      });
      std::rotate(groups.begin(), nearest, groups.end());
      ends[0] = ends[1] = add_end(groups.front(), PassageEnd::Kind::ring, shares_of({&groups.front(), 1}));
    } else {
      for (std::size_t side = 0; side < 2; ++side) {
        if (chain.junctions[side] != kNoGroup) {
          ends[side] = end_of_group_[chain.junctions[side]];
          continue;
        }
        const std::size_t n = std::min(kLast, groups.size());
        std::vector<std::uint32_t> last(groups.begin(), groups.begin() + static_cast<std::ptrdiff_t>(n));
        if (side == 1) std::copy_n(groups.rbegin(), n, last.begin());
        ends[side] = add_last(last);
      }
    }
    const auto index = static_cast<std::uint32_t>(out_.passages.size());
    for (const std::uint32_t g : groups) passage_of_group_[g] = index;
    for (const std::uint32_t e : ends) ++out_.ends[e].ways;
    Passage passage;
    passage.ends = ends;
    const Shares shares = shares_of(groups);
    passage.volume_m3 = shares.volume_m3;
    passage.frontier_m2 = shares.frontier_m2;
    measure(groups, chain, passage);
    out_.passages.push_back(passage);
  }

  /// Length, middle, widths and heights. The outermost slices of three or more are cut off by what ends the
  /// passage, and do not count for its width.
  void measure(const std::vector<std::uint32_t>& groups, const SliceChain& chain, Passage& passage) const {
    std::vector<Vec3> line;
    if (chain.junctions[0] != kNoGroup) line.push_back(section_of(chain.junctions[0]).center);
    for (const std::uint32_t g : groups) line.push_back(section_of(g).center);
    if (chain.junctions[1] != kNoGroup) line.push_back(section_of(chain.junctions[1]).center);
    if (chain.is_ring) line.push_back(line.front());
    std::vector<double> to{0.0};
    for (std::size_t i = 1; i < line.size(); ++i) to.push_back(to.back() + (line[i] - line[i - 1]).norm());
    passage.length_m = to.back();
    const auto half =
        static_cast<std::size_t>(std::lower_bound(to.begin(), to.end(), 0.5 * to.back()) - to.begin());
    passage.middle = line[half];

    std::vector<std::uint32_t> measured = groups;
    if (measured.size() >= 3 && chain.junctions[1] == kNoGroup && !chain.is_ring) measured.pop_back();
    if (measured.size() >= 3 && chain.junctions[0] == kNoGroup && !chain.is_ring)
      measured.erase(measured.begin());
    if (measured.empty()) measured = {chain.junctions[0], chain.junctions[1]};
    passage.least_width_m = passage.least_height_m = std::numeric_limits<double>::infinity();
    for (const std::uint32_t g : measured) {
      const CrossSection& s = section_of(g);
      passage.mean_width_m += s.width_m / static_cast<double>(measured.size());
      passage.mean_height_m += s.height_m / static_cast<double>(measured.size());
      passage.least_width_m = std::min(passage.least_width_m, s.width_m);
      passage.least_height_m = std::min(passage.least_height_m, s.height_m);
    }
  }

  /// Sorts ends and passages by distance from the start, then by place.
  void order() {
    const auto place = [](const Vec3& p) { return std::tuple(p.x(), p.y(), p.z()); };
    const std::vector<std::uint32_t> ends =
        sorted(out_.ends, end_of_group_, [&](const PassageEnd& a, const PassageEnd& b) {
          return std::tuple(a.from_start_m, place(a.position)) <
                 std::tuple(b.from_start_m, place(b.position));
        });
    for (Passage& p : out_.passages) {
      p.ends = {ends[p.ends[0]], ends[p.ends[1]]};
      if (p.ends[0] > p.ends[1]) std::swap(p.ends[0], p.ends[1]);
    }
    sorted(out_.passages, passage_of_group_, [&](const Passage& a, const Passage& b) {
      return std::tuple(a.ends, place(a.middle)) < std::tuple(b.ends, place(b.middle));
    });
  }
  /// Sorts `items`, and renumbers the references to them. Returns the new number of each.
  template <class Item, class Less>
  static std::vector<std::uint32_t> sorted(std::vector<Item>& items, std::vector<std::uint32_t>& references,
                                           Less&& less) {
    std::vector<std::uint32_t> order(items.size()), number(items.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return less(items[a], items[b]); });
    std::vector<Item> out;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      number[order[i]] = i;
      out.push_back(items[order[i]]);
    }
    items = std::move(out);
    for (std::uint32_t& r : references)
      if (r != kNoPassage) r = number[r];
    return number;
  }

  void place_slices() {
    out_.places_.resize(sections_.size());
    for (std::uint32_t g = 0; g < groups_.size(); ++g)
      for (const std::uint32_t s : groups_[g].slices)
        out_.places_[s] = {passage_of_group_[g], end_of_group_[g], from_start_m(s), sections_[s].width_m,
                           sections_[s].height_m};
    out_.slice_of_ = std::move(slices_.slice_of);
  }

  double cell_m_, band_m_;
  Slices slices_;
  std::vector<CrossSection> sections_;  // of each slice
  std::vector<SliceGroup> groups_;
  std::vector<std::uint32_t> end_of_group_, passage_of_group_;
  PassageMap out_;
};

PassagePlace PassageMap::at(const Vec3& p) const {
  const std::uint32_t part = space_.nearest(p);
  return part == kNoPart ? PassagePlace{} : places_[slice_of_[part]];
}

std::optional<PassageMap> find_passages(const VoxelMap& map, const Vec3& start, WorkBudget& work) {
  std::optional<FreeParts> space = free_parts_around(map, start, work);
  if (!space) return std::nullopt;
  if (space->parts.empty()) return PassageMap{};
  Slices slices = sliced(*space);
  if (!work.spend(kSliceWork * slices.slices.size())) return std::nullopt;
  return PassageMapBuilder(map, std::move(*space), std::move(slices)).build();
}

}  // namespace karst::core
