#include "sdk/cave_drawing/survey_drawings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/cave_drawing/cell_mask.h"
#include "sdk/cave_drawing/fill_polygon.h"
#include "sdk/cave_drawing/height_text.h"
#include "sdk/cave_drawing/leg_walls.h"
#include "sdk/cave_drawing/map_plan.h"
#include "sdk/cave_drawing/projection.h"
#include "sdk/cave_drawing/strip_places.h"
#include "sdk/cave_drawing/unrolled_survey.h"
#include "sdk/cave_drawing/wall_trace.h"

namespace karst::cave_drawing {
namespace {

using core::Vec3;

/// A piece of passage: what was measured at both ends of a leg, and a disc where it is steep.
struct Piece {
  std::vector<Point> around;
  std::optional<Point> disc;
  double radius_m = 0;
};

void expect_drawable(const survey::Survey& survey, std::optional<double> bearing_rad,
                     const std::string& file) {
  if (std::none_of(survey.legs.begin(), survey.legs.end(), [](const survey::Leg& l) { return !l.surface; }))
    throw core::InputError(file, "", "the survey has no leg underground: there is nothing to draw");
  if (bearing_rad && !std::isfinite(*bearing_rad))
    throw core::InputError(file, "", "the bearing is not a number");
  for (const survey::Station& s : survey.stations)
    if (!s.position_m.allFinite())
      throw core::InputError(file, "station " + s.name, "its position is not a number");
}

void fill_piece(CellMask& mask, const Piece& piece, double cell_m) {
  std::vector<Point> in_cells;
  for (const Point& p : piece.around) in_cells.push_back(p / cell_m);
  fill_convex(mask, convex_hull(std::move(in_cells)));
  if (piece.disc) fill_disc(mask, *piece.disc / cell_m, piece.radius_m / cell_m);
}

/// A passage as it is drawn, and as far as it was measured.
struct Pieces {
  std::vector<Piece> drawn, measured;
};

/// Fills the pieces into cells fine enough for print, and draws their outline. It is uncertain where it is
/// not that of what was measured.
void draw_pieces(const Pieces& both, Drawing& drawing, const std::string& file) {
  const std::vector<Piece>& pieces = both.drawn;
  constexpr double kAcross = 2500, kFinest_m = 0.05, kCoarsest_m = 0.5;
  constexpr double kDrawnCells = 2.5e7;  // 5000 by 5000: paper resolves no more
  Point low = Point::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto cover = [&](const Point& p, double around_m) {
    low = low.cwiseMin(p - Point::Constant(around_m));
    high = high.cwiseMax(p + Point::Constant(around_m));
  };
  for (const Piece& piece : pieces) {
    for (const Point& p : piece.around) cover(p, 0);
    if (piece.disc) cover(*piece.disc, piece.radius_m);
  }
  if (!low.allFinite() || !high.allFinite()) return;
  const Point size = high - low;
  const double cell_m = std::max(std::clamp(size.maxCoeff() / kAcross, kFinest_m, kCoarsest_m),
                                 std::sqrt(size.prod() / kDrawnCells));
  const auto cell = [&](double v) { return static_cast<std::int64_t>(std::floor(v / cell_m)); };
  CellMask mask(file, cell(low.x()) - 1, cell(low.y()) - 1, cell(high.x()) + 1, cell(high.y()) + 1);
  CellMask measured = mask;
  for (const Piece& piece : pieces) fill_piece(mask, piece, cell_m);
  for (const Piece& piece : both.measured) fill_piece(measured, piece, cell_m);
  draw_mask(mask, cell_m, drawing, [&](int x, int y, std::size_t side) {
    // The wall's own cell, or the next one further in: two fillings may round differently.
    return measured.at(x, y) || measured.at(x - kBesideX[side], y - kBesideY[side]);
  });
}

std::string short_name(const std::string& full) {
  const std::size_t dot = full.rfind('.');
  return dot == std::string::npos ? full : full.substr(dot + 1);
}

class SurveyDrawer {
 public:
  SurveyDrawer(const survey::Survey& survey, double bearing_rad, std::string file)
      : survey_(survey),
        file_(std::move(file)),
        bearing_rad_(bearing_rad),
        walls_(survey),
        unrolled_(unrolled_survey(survey)),
        legs_at_(survey.stations.size()) {
    for (const survey::Leg& l : survey.legs)
      if (!l.surface) ++legs_at_[l.from], ++legs_at_[l.to];
    zero_ = survey.stations[unrolled_.first].position_m;
  }

  Drawing plan() const {
    Drawing out = flat([](const Vec3& p) -> Point { return p.head<2>(); }, false);
    out.view = View::plan;
    return out;
  }

  Drawing projected_profile() const {
    Drawing out = flat([&](const Vec3& p) { return projected(p, zero_, bearing_rad_); }, true);
    out.view = View::projected_profile;
    out.bearing_rad = bearing_rad_;
    return out;
  }

  Drawing extended_profile() const {
    Drawing out;
    out.view = View::extended_profile;
    Pieces pieces;
    for (std::size_t i = 0; i < survey_.legs.size(); ++i) {
      if (!unrolled_.legs[i]) continue;
      const LegPassage passage = walls_.of(survey_.legs[i]);
      const auto [from, to] = *unrolled_.legs[i];
      const Point a(from, height(passage.drawn[0].station)), b(to, height(passage.drawn[1].station));
      out.centreline.push_back({a, b});
      pieces.drawn.push_back(upright_piece(passage.drawn, a, b));
      pieces.measured.push_back(upright_piece(passage.measured, a, b));
    }
    draw_pieces(pieces, out, file_);
    for (std::size_t i = 0; i < unrolled_.twice.size(); ++i) {
      const StationTwice& t = unrolled_.twice[i];
      const double z = height(survey_.stations[t.station].position_m);
      const Point here(t.s_m, z), again(t.again_s_m, z);
      if (t.is_moved) out.links.push_back({here, again});
      for (const Point& p : {here, again}) out.marks.push_back({Mark::Kind::joint, p, letters(i)});
    }
    add_marks(out, [&](std::size_t i) -> std::optional<Point> {
      if (!unrolled_.s_m[i]) return std::nullopt;
      return Point(*unrolled_.s_m[i], height(survey_.stations[i].position_m));
    });
    return out;
  }

 private:
  double height(const Vec3& p) const { return p.z() - zero_.z(); }

  static Piece upright_piece(const std::array<LegEnd, 2>& ends, const Point& a, const Point& b) {
    Piece piece;
    const double wide_m = is_steep(ends) ? 0.25 * (ends[0].width_m + ends[1].width_m) : 0;
    for (const double aside : {-wide_m, wide_m})
      piece.around.insert(piece.around.end(),
                          {a + Point(aside, ends[0].up_m), a + Point(aside, -ends[0].down_m),
                           b + Point(aside, ends[1].up_m), b + Point(aside, -ends[1].down_m)});
    return piece;
  }

  template <class Seen>
  static Piece flat_piece(const std::array<LegEnd, 2>& ends, const Seen& seen, bool from_aside) {
    Piece piece;
    for (const LegEnd& end : ends) {
      piece.around.insert(piece.around.end(), {seen(end.left), seen(end.right), seen(end.station)});
      if (!from_aside) continue;
      piece.around.push_back(seen(end.station + end.up_m * Vec3::UnitZ()));
      piece.around.push_back(seen(end.station - end.down_m * Vec3::UnitZ()));
    }
    const LegEnd& wider = ends[0].width_m > ends[1].width_m ? ends[0] : ends[1];
    if (!from_aside && is_steep(ends) && wider.width_m > 0) {
      piece.disc = seen(0.5 * (wider.left + wider.right));
      piece.radius_m = 0.5 * wider.width_m;
    }
    return piece;
  }

  /// A plan or a projected profile: `seen` gives the place of a point.
  template <class Seen>
  Drawing flat(const Seen& seen, bool from_aside) const {
    Drawing out;
    Pieces pieces;
    for (const survey::Leg& leg : survey_.legs) {
      if (leg.surface) continue;
      const LegPassage passage = walls_.of(leg);
      out.centreline.push_back({seen(passage.drawn[0].station), seen(passage.drawn[1].station)});
      pieces.drawn.push_back(flat_piece(passage.drawn, seen, from_aside));
      pieces.measured.push_back(flat_piece(passage.measured, seen, from_aside));
    }
    for (const survey::Splay& s : survey_.splays)
      if (!s.surface && s.end_m.allFinite())
        out.splays.push_back({seen(survey_.stations[s.station].position_m), seen(s.end_m)});
    draw_pieces(pieces, out, file_);
    add_marks(out,
              [&](std::size_t i) -> std::optional<Point> { return seen(survey_.stations[i].position_m); });
    return out;
  }

  template <class Where>
  void add_marks(Drawing& out, const Where& where) const {
    for (std::size_t i = 0; i < survey_.stations.size(); ++i) {
      const survey::Station& s = survey_.stations[i];
      if (legs_at_[i] == 0) continue;
      const std::optional<Point> at = where(i);
      if (!at) continue;
      if (s.entrance) out.marks.push_back({Mark::Kind::entrance, *at, "entrance"});
      if (s.continuation) out.marks.push_back({Mark::Kind::unknown_end, *at, "?"});
      if (legs_at_[i] != 2 && !s.entrance)
        out.marks.push_back({Mark::Kind::height, *at, height_text(height(s.position_m))});
      out.marks.push_back({Mark::Kind::station, *at, short_name(s.name)});
    }
  }

  const survey::Survey& survey_;
  std::string file_;
  double bearing_rad_;
  LegWalls walls_;
  UnrolledSurvey unrolled_;
  std::vector<int> legs_at_;  // underground, of each station
  Vec3 zero_ = Vec3::Zero();  // the entrance
};

}  // namespace

CaveDrawings survey_drawings(const survey::Survey& survey, std::optional<double> bearing_rad,
                             const std::string& file) {
  expect_drawable(survey, bearing_rad, file);
  std::vector<Point> places;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const survey::Leg& leg : survey.legs) {
    if (leg.surface) continue;
    for (const std::uint32_t end : {leg.from, leg.to}) {
      const Vec3& p = survey.stations[end].position_m;
      places.emplace_back(p.head<2>());
      lowest = std::min(lowest, p.z());
      highest = std::max(highest, p.z());
    }
  }
  const SurveyDrawer drawer(survey, bearing_rad.value_or(longest_bearing(convex_hull(places))), file);
  CaveDrawings out{{}, drawer.plan(), drawer.extended_profile(), drawer.projected_profile()};
  out.facts.name = survey.title.empty() ? std::filesystem::path(file).stem().string() : survey.title;
  out.facts.from = "survey";
  out.facts.length_m = survey::length_m(survey);
  out.facts.depth_m = highest - lowest;
  return out;
}

}  // namespace karst::cave_drawing
