// What a policy decides.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/geometry.h"

namespace karst::core {

struct Goal {
  Vec3 position = Vec3::Zero();
  double heading_rad = 0;         // NaN: any
  double tolerance_m = 0.5;       // reached when nearer than this
  double max_speed_mps = 0;       // 0: the mission's; a greater one is cut to it
  std::uint32_t frontier_id = 0;  // 0: none
  double score = 0;
  std::string why;  // one line for the report
};

enum class Outcome { goals, hold, explored, go_home };
constexpr auto names_of(Outcome) {
  using enum Outcome;
  return std::to_array<Named<Outcome>>(
      {{goals, "goals"}, {hold, "hold"}, {explored, "explored"}, {go_home, "go_home"}});
}

/// Something a policy drew into the report.
struct Drawing {
  enum class Kind { points, lines, text } kind = Kind::points;
  std::vector<Vec3> points;  // lines: pairs
  std::uint32_t rgb = 0xffffff;
  std::string text;
};
constexpr auto names_of(Drawing::Kind) {
  using enum Drawing::Kind;
  return std::to_array<Named<Drawing::Kind>>({{points, "points"}, {lines, "lines"}, {text, "text"}});
}

struct Decision {
  Outcome outcome = Outcome::hold;
  std::vector<Goal> goals;  // best first
  std::string reason;       // for hold, explored and go_home
  std::vector<Drawing> drawings;
  std::vector<std::string> log;
};

}  // namespace karst::core
