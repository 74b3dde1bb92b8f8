#include "sdk/cave_drawing/strip_places.h"

namespace karst::cave_drawing {
namespace {

constexpr int kMostShifts = 5000;  // 20 km

bool is_free(const ProfileCells& drawn, const ProfileCells& strip, const StripPlace& place, int apart,
             int hall) {
  for (const auto& [x, runs] : strip) {
    if (x < hall) continue;  // where it branches off, they overlap
    const int at = place.of(x);
    for (auto it = drawn.lower_bound(at - apart); it != drawn.end() && it->first <= at + apart; ++it)
      for (const Run& other : it->second)
        for (const Run& run : runs)
          if (run.low - apart <= other.high && other.low - apart <= run.high) return false;
  }
  return true;
}

}  // namespace

StripPlace place_for(const ProfileCells& drawn, const ProfileCells& strip, int column, int apart, int hall,
                     int shift, bool left_first) {
  for (const bool to_left : {left_first, !left_first})
    if (const StripPlace place{column, to_left}; is_free(drawn, strip, place, apart, hall)) return place;
  for (int i = 1; i < kMostShifts; ++i)
    if (const StripPlace place{column + i * shift, false}; is_free(drawn, strip, place, apart, 0))
      return place;
  return {column, left_first};
}

std::string letters(std::size_t i) {
  std::string text(1, static_cast<char>('a' + i % 26));
  return i < 26 ? text : letters(i / 26 - 1) + text;
}

}  // namespace karst::cave_drawing
