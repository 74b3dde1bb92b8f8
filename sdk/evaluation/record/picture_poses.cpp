#include "sdk/evaluation/record/picture_poses.h"

#include <array>
#include <cmath>

#include "sdk/evaluation/record/table.h"

namespace karst::evaluation {

std::vector<PicturePose> read_picture_poses(const std::filesystem::path& file,
                                            std::vector<std::string>& problems) {
  constexpr std::array kColumns = {"time_s",
                                   "x",
                                   "y",
                                   "z",
                                   "qx",
                                   "qy",
                                   "qz",
                                   "qw",
                                   "tan_half_width",
                                   "tan_half_height",
                                   "min_range_m",
                                   "max_range_m",
                                   "max_incidence_rad"};
  const Table table = read_table(file, {}, problems);
  std::array<const std::vector<double>*, kColumns.size()> column{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    column[i] = table.column(kColumns[i]);
    if (!column[i]) {
      if (table.rows > 0) problems.push_back(file.filename().string() + ": has no column " + kColumns[i]);
      return {};
    }
  }
  std::vector<PicturePose> poses;
  std::size_t bad = 0;
  for (std::size_t row = 0; row < table.rows; ++row) {
    std::array<double, kColumns.size()> v{};
    bool good = true;
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] = (*column[i])[row];
      good = good && std::isfinite(v[i]);
    }
    const core::Quat q(v[7], v[4], v[5], v[6]);
    if (!good || std::abs(q.norm() - 1) > 1e-3 || v[8] <= 0 || v[9] <= 0 || v[11] <= 0) {
      ++bad;
      continue;
    }
    poses.push_back({v[0], {{v[1], v[2], v[3]}, q.normalized()}, v[8], v[9], v[10], v[11], v[12]});
  }
  if (bad > 0)
    problems.push_back(file.filename().string() + ": " + std::to_string(bad) +
                       " rows are no pose of a camera");
  return poses;
}

}  // namespace karst::evaluation
