#include "core_stack/perception/lonely_returns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core_stack/perception/lonely_points.h"

namespace karst::core {

void describe(OptionTable& t, LonelyReturnOptions& o) {
  t.add("agreement", o.agreement, "", 0, 1, "least share of its neighbours that a return agrees with");
  t.add("bright", o.bright, "", 0, 1, "reflectivity from which a return is kept whatever its neighbours say");
  t.add("judged_within", o.radius_m, "m", 0, 100, "only returns nearer to the sensor than this are judged");
  t.add("tolerance", o.tolerance_m, "m", 0.001, 1, "off a surface, near the sensor; 6 mm a metre are added");
}

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kMaxColumns = 4, kMaxRows = 2;
constexpr double kWindow_rad = 0.06;
constexpr float kTolerancePerMetre = 0.006f, kSlope = 0.3f;
constexpr int kMinNeighbours = 3;
constexpr float kIntensityRange_m = 25;  // where a unit's intensity has fallen to half

/// For each channel, by how many columns its scan lags so that beams of one azimuth stand in one column.
std::vector<std::size_t> shifts_of(const LidarModel& model) {
  std::vector<std::size_t> shifts(model.elevation_rad.size());
  const long columns = model.columns;
  for (std::size_t c = 0; c < model.azimuth_offset_rad.size() && c < shifts.size(); ++c) {
    const double turns = static_cast<double>(model.azimuth_offset_rad[c]) / (2 * std::numbers::pi);
    shifts[c] = static_cast<std::size_t>((std::lround(turns * model.columns) % columns + columns) % columns);
  }
  return shifts;
}

/// The ranges with a margin of what no beam measured; rows are closed to rings. Column j is column
/// j + shift of the scan, modulo its columns.
class Ranges {
 public:
  Ranges(const LidarScan& scan, const std::vector<std::size_t>& shifts)
      : width_(static_cast<std::size_t>(scan.model->columns) + 2 * kMaxColumns),
        range_(width_ * (scan.model->elevation_rad.size() + 2 * kMaxRows), kNan) {
    const auto columns = static_cast<std::size_t>(scan.model->columns);
    for (std::size_t row = 0; row < scan.model->elevation_rad.size(); ++row) {
      const float* from = scan.range_m.data() + row * columns;
      float* to = range_.data() + (row + kMaxRows) * width_;
      const auto valid = [](float r) { return std::isfinite(r) && r > 0 ? r : kNan; };
      float* rest = std::transform(from + shifts[row], from + columns, to + kMaxColumns, valid);
      std::transform(from, from + shifts[row], rest, valid);
      std::copy_n(to + columns, kMaxColumns, to);
      std::copy_n(to + kMaxColumns, kMaxColumns, to + kMaxColumns + columns);
    }
  }
  /// The first beam of a row, and columns before and after it as far as the window reaches.
  const float* row(std::size_t row, int up) const {
    return range_.data() + (row + kMaxRows + static_cast<std::size_t>(up)) * width_ + kMaxColumns;
  }

 private:
  std::size_t width_;
  std::vector<float> range_;
};

struct Offset {
  int row, column;
  float angle_rad;
};

/// Half of the window around a beam; the other half lies opposite.
std::vector<Offset> window(const LidarModel& model) {
  const double column_rad = 2 * std::numbers::pi / model.columns;
  const auto channels = model.elevation_rad.size();
  const double row_rad = channels < 2
                             ? 1.0
                             : static_cast<double>(model.elevation_rad.front() - model.elevation_rad.back()) /
                                   static_cast<double>(channels - 1);
  const auto half_window = [](double step_rad, int most) {
    return std::clamp(static_cast<int>(std::lround(kWindow_rad / step_rad)), 1, most);
  };
  const int columns = half_window(column_rad, std::min(kMaxColumns, (model.columns - 1) / 2)),
            rows = half_window(row_rad, kMaxRows);
  std::vector<Offset> offsets;
  const auto add = [&](int r, int c) {
    offsets.push_back({r, c, static_cast<float>(std::hypot(r * row_rad, c * column_rad))});
  };
  for (int c = 1; c <= columns; ++c) add(0, c);
  for (int r = 1; r <= rows; ++r)
    for (int c = columns; c >= -columns; c -= 2) add(r, c);
  return offsets;
}

/// Of one row of beams: how many neighbours each has, and how many agree with it.
struct Votes {
  float *there, *agree;
};

void count_votes(const Ranges& ranges, std::size_t row, std::ptrdiff_t columns,
                 const std::vector<Offset>& offsets, float tolerance_m, const Votes& votes) {
  std::fill(votes.there, votes.there + columns, 0.0f);
  std::fill(votes.agree, votes.agree + columns, 0.0f);
  const float* here = ranges.row(row, 0);
  float *there = votes.there, *agree = votes.agree;
  for (const Offset& o : offsets) {
    const float *one = ranges.row(row, o.row) + o.column, *other = ranges.row(row, -o.row) - o.column;
    const float twice_cosine = 2 * std::cos(o.angle_rad), slope = kSlope * o.angle_rad;
    // Branches would cost more than they save: comparisons with NaN are false, and missing beams are NaN.
    for (std::ptrdiff_t j = 0; j < columns; ++j) {
      const float r = here[j], a = one[j], b = other[j];
      const float off_m = std::abs(1 / a + 1 / b - twice_cosine / r) * r * r / 2;
      const float near_m = tolerance_m + slope * r;
      const float plane = off_m < tolerance_m + kTolerancePerMetre * r ? 2.0f : 0.0f;
      const float level = (std::abs(a - r) < near_m ? 1.0f : 0.0f) + (std::abs(b - r) < near_m ? 1.0f : 0.0f);
      there[j] += (a == a ? 1.0f : 0.0f) + (b == b ? 1.0f : 0.0f);
      agree[j] += plane > level ? plane : level;
    }
  }
}

}  // namespace

void drop_lonely_returns(LidarScan& scan, const LonelyReturnOptions& options) {
  if (scan.model && !scan.model->has_rings()) return drop_lonely_points(scan, options);
  if (!scan.model || scan.model->columns < 3 || scan.intensity.size() != scan.range_m.size()) return;
  const auto columns = static_cast<std::size_t>(scan.model->columns), rows = scan.model->elevation_rad.size();
  if (columns * rows != scan.range_m.size()) return;
  const std::vector<Offset> offsets = window(*scan.model);
  const std::vector<std::size_t> shifts = shifts_of(*scan.model);
  const auto radius_m = static_cast<float>(options.radius_m),
             fraction = static_cast<float>(options.agreement), bright = static_cast<float>(options.bright),
             tolerance_m = static_cast<float>(options.tolerance_m);
  std::vector<float> there(columns), first_there(scan.range_m.size()), agree(columns);
  // What the first round drops agrees with nobody in the second, but is still there: clumps of dust dissolve.
  for (const int round : {0, 1}) {
    const Ranges ranges(scan, shifts);
    for (std::size_t row = 0; row < rows; ++row) {
      float* neighbours = first_there.data() + row * columns;
      count_votes(ranges, row, static_cast<std::ptrdiff_t>(columns), offsets, tolerance_m,
                  {round == 0 ? neighbours : there.data(), agree.data()});
      for (std::size_t j = 0; j < columns; ++j) {
        const std::size_t beam = row * columns + (j + shifts[row]) % columns;
        float& range_m = scan.range_m[beam];
        const float x = range_m / kIntensityRange_m;
        const float reflectivity = scan.intensity[beam] * (1 + x * x);
        if (!(range_m < radius_m) || reflectivity >= bright) continue;
        if (neighbours[j] < kMinNeighbours || agree[j] < fraction * neighbours[j]) range_m = kNan;
      }
    }
  }
}

}  // namespace karst::core
