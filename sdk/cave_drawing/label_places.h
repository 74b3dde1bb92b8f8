// Where names and numbers have room beside what they name, without covering each other.
#pragma once
#include <optional>
#include <vector>

#include "sdk/cave_drawing/sheet.h"

namespace karst::cave_drawing {

class LabelPlaces {
 public:
  explicit LabelPlaces(const Frame& frame) : frame_(frame) {}

  /// The lower left corner of a label of this size beside `at`, in mm, and keeps the place; none if there is
  /// no room in the frame.
  std::optional<Point> beside(const Point& at, double width_mm, double height_mm);
  /// As beside(); if there is no room, where it covers something, but within the frame.
  Point beside_anyhow(const Point& at, double width_mm, double height_mm);
  /// Keeps the place of a symbol.
  void keep(const Point& middle, double width_mm, double height_mm);

 private:
  struct Box {
    double left, top, right, bottom;
  };
  bool is_free(const Box& b) const;

  Frame frame_;
  std::vector<Box> taken_;
};

}  // namespace karst::cave_drawing
