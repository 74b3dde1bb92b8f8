#include "sdk/evaluation/record/poses.h"

#include <array>
#include <charconv>
#include <cmath>

#include "core_stack/common/pose_track.h"
#include "sdk/evaluation/record/lines.h"

namespace karst::evaluation {

namespace {

/// Parses the eight finite numbers of a line; false if it contains anything else.
bool parse_line(const std::string& line, std::array<double, 8>& v) {
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto skip = [&] {
    while (at < end && (*at == ' ' || *at == '\t')) ++at;
  };
  for (double& number : v) {
    skip();
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    at = next;
  }
  skip();
  return at == end;
}

bool is_unit(const std::array<double, 8>& v) {
  return std::abs(core::Quat(v[7], v[4], v[5], v[6]).norm() - 1.0) <= 0.01;
}

StampedPose pose_of(const std::array<double, 8>& v) {
  return {v[0], {core::Vec3(v[1], v[2], v[3]), core::Quat(v[7], v[4], v[5], v[6]).normalized()}};
}

}  // namespace

std::optional<StampedPose> pose_of_line(const std::string& line) {
  std::array<double, 8> v;
  if (!parse_line(line, v) || !is_unit(v)) return std::nullopt;
  return pose_of(v);
}

std::vector<StampedPose> read_tum(const std::filesystem::path& file, std::vector<std::string>& problems) {
  std::vector<StampedPose> poses;
  const std::vector<std::string> lines = read_lines(file, problems);
  BadLines bad(file);
  std::array<double, 8> v;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i][0] == '#') continue;
    if (!parse_line(lines[i], v)) {
      bad.add(i + 1, "is not eight numbers");
      continue;
    }
    if (!is_unit(v)) {
      bad.add(i + 1, "its quaternion is not of unit length");
      continue;
    }
    if (!poses.empty() && v[0] < poses.back().t_s) {
      bad.add(i + 1, "goes back in time");
      continue;
    }
    poses.push_back(pose_of(v));
  }
  bad.report(problems);
  return poses;
}

core::Pose pose_at(const std::vector<StampedPose>& poses, double t_s) {
  return core::pose_on_track(poses, t_s, &StampedPose::t_s, &StampedPose::T_world_body);
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
