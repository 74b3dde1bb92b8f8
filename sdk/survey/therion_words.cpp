#include "sdk/survey/therion_words.h"

#include <algorithm>

namespace karst::survey {
namespace {

struct ColumnWord {
  std::string_view word;
  Column column;
};
constexpr auto kColumnWords = [] {
  using enum Column;
  return std::to_array<ColumnWord>({{"station", station},
                                    {"from", from},
                                    {"to", to},
                                    {"direction", direction},
                                    {"length", length},
                                    {"tape", length},
                                    {"backlength", back_length},
                                    {"backtape", back_length},
                                    {"bearing", bearing},
                                    {"compass", bearing},
                                    {"backbearing", back_bearing},
                                    {"backcompass", back_bearing},
                                    {"gradient", gradient},
                                    {"clino", gradient},
                                    {"backgradient", back_gradient},
                                    {"backclino", back_gradient},
                                    {"count", count},
                                    {"counter", count},
                                    {"fromcount", from_count},
                                    {"fromcounter", from_count},
                                    {"tocount", to_count},
                                    {"tocounter", to_count},
                                    {"depth", depth},
                                    {"fromdepth", from_depth},
                                    {"todepth", to_depth},
                                    {"depthchange", depth_change},
                                    {"northing", northing},
                                    {"dy", northing},
                                    {"easting", easting},
                                    {"dx", easting},
                                    {"altitude", altitude},
                                    {"dz", altitude},
                                    {"up", up},
                                    {"ceiling", up},
                                    {"down", down},
                                    {"floor", down},
                                    {"left", left},
                                    {"right", right},
                                    {"newline", newline},
                                    {"ignore", ignore},
                                    {"ignoreall", ignore_all}});
}();

std::optional<Quantity> quantity_of(Column column) {
  switch (column) {
    case Column::length:
    case Column::back_length:
      return Quantity::length;
    case Column::count:
      return Quantity::counter;
    case Column::depth:
    case Column::depth_change:
      return Quantity::depth;
    case Column::northing:
      return Quantity::northing;
    case Column::easting:
      return Quantity::easting;
    case Column::altitude:
      return Quantity::altitude;
    case Column::up:
      return Quantity::up;
    case Column::down:
      return Quantity::down;
    case Column::left:
      return Quantity::left;
    case Column::right:
      return Quantity::right;
    case Column::bearing:
      return Quantity::bearing;
    case Column::gradient:
      return Quantity::gradient;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<Column> column_of(std::string_view word) {
  for (const ColumnWord& c : kColumnWords)
    if (c.word == word) return c.column;
  return std::nullopt;
}

std::vector<Quantity> quantities_of(std::string_view word) {
  using enum Quantity;
  if (word == "position") return {x, y, z};
  if (word == "dimensions") return {up, down, left, right};
  if (word == "x") return {x};
  if (word == "y") return {y};
  if (word == "z") return {z};
  if (const auto column = column_of(word))
    if (const auto quantity = quantity_of(*column)) return {*quantity};
  return {};
}

bool is_remark(std::string_view command) {
  constexpr auto kRemarks = std::to_array<std::string_view>(
      {"team", "explo-team", "explo-date", "instrument", "instruments", "mark", "walls", "shape",
       "vthreshold", "title", "author", "copyright", "attr", "id", "assistant"});
  return std::find(kRemarks.begin(), kRemarks.end(), command) != kRemarks.end();
}

}  // namespace karst::survey
