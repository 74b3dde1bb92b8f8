#include "sdk/cave_drawing/wall_trace.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

namespace karst::cave_drawing {
namespace {

constexpr std::array<int, 4> kStepX{1, 0, -1, 0}, kStepY{0, 1, 0, -1};

using Corner = std::pair<int, int>;  // y, x

/// The sides that are left, by the corner where they begin.
class SidesLeft {
 public:
  explicit SidesLeft(const std::vector<CellSide>& sides) {
    for (const CellSide& s : sides) {
      bits_[{s.y, s.x}] |= static_cast<std::uint8_t>(1u << s.heading);
      --surplus_[{s.y, s.x}];
      ++surplus_[{s.y + kStepY[s.heading], s.x + kStepX[s.heading]}];
    }
  }

  /// Where a line begins that is not closed, or else any.
  std::optional<Corner> begin() {
    for (; from_ != surplus_.end(); ++from_)
      if (from_->second < 0) {
        ++from_->second;
        return from_->first;
      }
    while (!bits_.empty() && bits_.begin()->second == 0) bits_.erase(bits_.begin());
    if (bits_.empty()) return std::nullopt;
    return bits_.begin()->first;
  }

  /// Takes the side that goes on from the corner, the leftmost if there are several.
  std::optional<std::uint8_t> take(const Corner& at, std::optional<std::uint8_t> came) {
    const auto it = bits_.find(at);
    if (it == bits_.end() || it->second == 0) return std::nullopt;
    for (const unsigned turn : {1u, 0u, 3u, 2u}) {
      const auto heading = static_cast<std::uint8_t>((came.value_or(0) + turn) % 4);
      if ((it->second >> heading & 1u) == 0) continue;
      it->second = static_cast<std::uint8_t>(it->second & ~(1u << heading));
      return heading;
    }
    return std::nullopt;
  }

  /// Open lines begin first.
  void find_open_ends() { from_ = surplus_.begin(); }

 private:
  std::map<Corner, std::uint8_t> bits_;
  std::map<Corner, int> surplus_;  // sides that end there, less those that begin there
  std::map<Corner, int>::iterator from_;
};

}  // namespace

CellSide side_of(int x, int y, std::uint8_t side) {
  switch (side) {
    case 0:
      return {x, y, 0};
    case 1:
      return {x + 1, y, 1};
    case 2:
      return {x + 1, y + 1, 2};
    default:
      return {x, y + 1, 3};
  }
}

std::vector<Line> joined(const std::vector<CellSide>& sides) {
  std::vector<Line> lines;
  SidesLeft left(sides);
  left.find_open_ends();
  while (const auto start = left.begin()) {
    Corner at = *start;
    Line line{Point(at.second, at.first)};
    std::optional<std::uint8_t> heading;
    while ((heading = left.take(at, heading))) {
      at = {at.first + kStepY[*heading], at.second + kStepX[*heading]};
      line.emplace_back(at.second, at.first);
      if (at == *start) break;
    }
    if (line.size() > 1) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<Line> outlines_of(const CellMask& mask) {
  std::vector<CellSide> sides;
  for (int y = mask.low_y(); y <= mask.high_y(); ++y)
    for (int x = mask.low_x(); x <= mask.high_x(); ++x) {
      if (!mask.at(x, y)) continue;
      for (std::uint8_t side = 0; side < 4; ++side)
        if (!mask.at(x + kBesideX[side], y + kBesideY[side])) sides.push_back(side_of(x, y, side));
    }
  return joined(sides);
}

double signed_area(const Line& ring) {
  double twice = 0;
  for (std::size_t i = 1; i < ring.size(); ++i)
    twice += ring[i - 1].x() * ring[i].y() - ring[i].x() * ring[i - 1].y();
  return 0.5 * twice;
}

}  // namespace karst::cave_drawing
