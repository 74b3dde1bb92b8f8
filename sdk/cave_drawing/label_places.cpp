#include "sdk/cave_drawing/label_places.h"

#include <algorithm>
#include <array>

namespace karst::cave_drawing {
namespace {

constexpr double kAside_mm = 1.6;  // from a mark's middle to its label

}  // namespace

bool LabelPlaces::is_free(const Box& b) const {
  if (b.left < frame_.left_mm || b.top < frame_.top_mm || b.right > frame_.left_mm + frame_.width_mm ||
      b.bottom > frame_.top_mm + frame_.height_mm)
    return false;
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box& t) {
    return b.left < t.right && t.left < b.right && b.top < t.bottom && t.top < b.bottom;
  });
}

std::optional<Point> LabelPlaces::beside(const Point& at, double width_mm, double height_mm) {
  const double right = at.x() + kAside_mm, left = at.x() - kAside_mm - width_mm;
  const double middle = at.x() - 0.5 * width_mm, level = at.y() + 0.5 * height_mm;
  const double above = at.y() - kAside_mm, below = at.y() + kAside_mm + height_mm;
  for (const Point& p : std::array<Point, 8>{Point(right, level), Point(left, level), Point(middle, above),
                                             Point(middle, below), Point(right, above), Point(right, below),
                                             Point(left, above), Point(left, below)}) {
    const Box b{p.x(), p.y() - height_mm, p.x() + width_mm, p.y()};
    if (!is_free(b)) continue;
    taken_.push_back(b);
    return p;
  }
  return std::nullopt;
}

Point LabelPlaces::beside_anyhow(const Point& at, double width_mm, double height_mm) {
  if (const auto place = beside(at, width_mm, height_mm)) return *place;
  const double most_x = std::max(frame_.left_mm, frame_.left_mm + frame_.width_mm - width_mm);
  const Point p(std::clamp(at.x() + kAside_mm, frame_.left_mm, most_x),
                std::clamp(at.y(), frame_.top_mm + height_mm, frame_.top_mm + frame_.height_mm));
  taken_.push_back({p.x(), p.y() - height_mm, p.x() + width_mm, p.y()});
  return p;
}

void LabelPlaces::keep(const Point& middle, double width_mm, double height_mm) {
  taken_.push_back({middle.x() - 0.5 * width_mm, middle.y() - 0.5 * height_mm, middle.x() + 0.5 * width_mm,
                    middle.y() + 0.5 * height_mm});
}

}  // namespace karst::cave_drawing
