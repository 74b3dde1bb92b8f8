#include "sdk/evaluation/poses.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sdk/evaluation/lines.h"

namespace karst::evaluation {

std::vector<StampedPose> read_tum(const std::filesystem::path& file, std::vector<std::string>& problems) {
  std::vector<StampedPose> poses;
  const std::vector<std::string> lines = read_lines(file, problems);
  BadLines bad(file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i][0] == '#') continue;
    std::istringstream words(lines[i]);
    std::string word;
    double v[8];
    int n = 0;
    while (n < 8 && words >> word && parse_number(word, v[n]) && std::isfinite(v[n])) ++n;
    if (n < 8 || words >> word) {
      bad.add(i + 1, "is not eight numbers");
      continue;
    }
    const core::Quat q(v[7], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1.0) > 0.01) {
      bad.add(i + 1, "its quaternion is not of unit length");
      continue;
    }
    if (!poses.empty() && v[0] < poses.back().t_s) {
      bad.add(i + 1, "goes back in time");
      continue;
    }
    poses.push_back({v[0], {core::Vec3(v[1], v[2], v[3]), q.normalized()}});
  }
  bad.report(problems);
  return poses;
}

core::Pose pose_at(const std::vector<StampedPose>& poses, double t_s) {
  const auto after = std::upper_bound(poses.begin(), poses.end(), t_s,
                                      [](double t, const StampedPose& p) { return t < p.t_s; });
  if (after == poses.begin()) return poses.front().T_world_body;
  if (after == poses.end()) return poses.back().T_world_body;
  const StampedPose& a = *(after - 1);
  const double s = (t_s - a.t_s) / (after->t_s - a.t_s);
  return {a.T_world_body.position + s * (after->T_world_body.position - a.T_world_body.position),
          a.T_world_body.orientation.slerp(s, after->T_world_body.orientation)};
}

double path_length_m(const std::vector<StampedPose>& poses, double from_s, double to_s) {
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i - 1].t_s < from_s || poses[i].t_s > to_s) continue;
    length += (poses[i].T_world_body.position - poses[i - 1].T_world_body.position).norm();
  }
  return length;
}

}  // namespace karst::evaluation
