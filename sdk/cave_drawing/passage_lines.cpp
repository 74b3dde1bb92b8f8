#include "sdk/cave_drawing/passage_lines.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/planning/passages/cross_section.h"
#include "core_stack/planning/passages/free_parts.h"
#include "core_stack/planning/passages/slice_graph.h"
#include "core_stack/planning/passages/slices.h"

namespace karst::cave_drawing {
namespace {

constexpr std::uint64_t kMostWork = 40 * core::kMaxPassageWork;  // half a minute: nothing flies meanwhile

/// Without ends that are nearer to the place before them than the wall is: corners of the passage there.
PassageLines without_corners(const PassageLines& lines) {
  std::vector<std::uint32_t> number(lines.points.size());
  std::uint32_t kept = 0;
  constexpr std::uint32_t kGone = ~std::uint32_t{0};
  for (std::uint32_t i = 0; i < lines.points.size(); ++i) {
    const PassagePoint& end = lines.points[i];
    bool corner = i != lines.first && end.next.size() == 1 && !end.leads_on;
    if (corner) {
      const PassagePoint& before = lines.points[end.next.front()];
      corner = before.next.size() > 1 && (end.middle - before.middle).norm() < 0.5 * before.width_m;
    }
    number[i] = corner ? kGone : kept++;
  }
  PassageLines out;
  out.first = number[lines.first];
  for (std::uint32_t i = 0; i < lines.points.size(); ++i) {
    if (number[i] == kGone) continue;
    PassagePoint point = lines.points[i];
    point.next.clear();
    for (const std::uint32_t j : lines.points[i].next)
      if (number[j] != kGone) point.next.push_back(number[j]);
    out.points.push_back(std::move(point));
  }
  return out;
}

}  // namespace

double PassageLines::length_m() const {
  double sum = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (const std::uint32_t j : points[i].next)
      if (i < j) sum += (points[i].middle - points[j].middle).norm();
  return sum;
}

PassageLines passage_lines(const core::VoxelMap& map, const core::Vec3& start, const std::string& file,
                           std::span<const core::Vec3> flown) {
  core::WorkBudget work(kMostWork);
  const std::optional<core::FreeParts> space = core::free_parts_around(map, start, work, flown);
  if (!space) throw core::InputError(file, "", "the map is too large to find its passages");
  PassageLines out;
  if (space->parts.empty() || space->start == core::kNoPart) return out;
  const core::Slices slices = core::sliced(*space);
  if (!work.spend(core::kSliceWork * slices.slices.size()))
    throw core::InputError(file, "", "the map is too large to find its passages");
  const double band_m = core::kBandCubes * space->grid.cube_m();
  std::vector<core::CrossSection> sections;
  for (const core::Slice& s : slices.slices)
    sections.push_back(core::cross_section(map, space->parts[s.middle].middle, 0.5 * band_m));
  const std::vector<core::SliceGroup> groups = core::simplified(slices.slices, sections, band_m);
  const std::uint32_t first_slice = slices.slice_of[space->start];
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const core::CrossSection& section = sections[groups[g].core];
    PassagePoint point{section.center, section.width_m, section.height_m, groups[g].next, false};
    if (point.next.size() < 2) {
      std::vector<std::uint32_t> last{g};
      last.insert(last.end(), point.next.begin(), point.next.end());
      point.leads_on = core::is_open_end(last, groups, slices.slices, space->grid);
    }
    if (std::binary_search(groups[g].slices.begin(), groups[g].slices.end(), first_slice)) out.first = g;
    out.points.push_back(std::move(point));
  }
  return without_corners(out);
}

}  // namespace karst::cave_drawing
