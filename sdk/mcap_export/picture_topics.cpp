#include "sdk/mcap_export/picture_topics.h"

#include <cmath>

#include "core_stack/common/input_file.h"
#include "sdk/evaluation/record/table.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

namespace fs = std::filesystem;
using evaluation::Table;

constexpr const char *kCameraFrame = "camera", *kOpticalFrame = "camera_optical";

/// ROS's optical frames (REP 103): z along the axis, x right, y down. karst's cameras: x along the axis, y
/// left.
core::Pose T_camera_optical() {
  Eigen::Matrix3d R;
  R << 0, 0, 1,  //
      -1, 0, 0,  //
      0, -1, 0;
  return {core::Vec3::Zero(), core::Quat(R)};
}

struct Frame {
  double t_s = 0;
  fs::path file;  // "" if the picture was not kept
  core::Pose T_world_camera;
  std::uint32_t width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

std::vector<Frame> frames_of(const fs::path& directory, std::vector<std::string>& problems) {
  const Table table = evaluation::read_table(directory / "frames.csv", {"file"}, problems);
  const auto file = table.text.find("file");
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const auto at = [&](const char* name) {
      const auto* column = table.column(name);
      return column ? (*column)[i] : std::nan("");
    };
    Frame f;
    f.t_s = at("stamp_s");
    if (file != table.text.end() && !file->second[i].empty()) f.file = directory / file->second[i];
    f.T_world_camera = {{at("x"), at("y"), at("z")}, core::Quat(at("qw"), at("qx"), at("qy"), at("qz"))};
    const double width = at("width"), height = at("height");
    f.fx = at("fx"), f.fy = at("fy"), f.cx = at("cx"), f.cy = at("cy");
    const bool known = std::isfinite(f.t_s + f.T_world_camera.position.sum() + f.fx + f.fy + f.cx + f.cy) &&
                       f.T_world_camera.orientation.coeffs().allFinite() && width > 0 && height > 0 &&
                       width < 1e5 && height < 1e5 && (frames.empty() || f.t_s >= frames.back().t_s);
    if (!known) {
      problems.push_back("frames.csv: picture " + std::to_string(i + 1) + " is not described; left out");
      continue;
    }
    f.width = static_cast<std::uint32_t>(width), f.height = static_cast<std::uint32_t>(height);
    frames.push_back(std::move(f));
  }
  return frames;
}

bool is_jpeg(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return in.get() == 0xff && in.get() == 0xd8;
}

/// Those whose picture can be read.
std::vector<Frame> with_pictures(const std::vector<Frame>& frames, std::vector<std::string>& problems) {
  std::vector<Frame> out;
  std::size_t missing = 0;
  std::string first;
  for (const Frame& f : frames) {
    if (f.file.empty()) continue;
    if (is_jpeg(f.file))
      out.push_back(f);
    else if (missing++ == 0)
      first = f.file.string();
  }
  if (missing > 0)
    problems.push_back(first + ": is missing or no JPEG file; " + std::to_string(missing) +
                       " pictures are left out");
  return out;
}

ros::CameraInfo info_of(const Frame& f, const FlightClock& clock) {
  ros::CameraInfo out;
  out.header = {clock.stamp(f.t_s), kOpticalFrame};
  out.height = f.height;
  out.width = f.width;
  out.distortion_model = "plumb_bob";
  out.d.assign(5, 0.0);
  out.k = {f.fx, 0, f.cx, 0, f.fy, f.cy, 0, 0, 1};
  out.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  out.p = {f.fx, 0, f.cx, 0, 0, f.fy, f.cy, 0, 0, 0, 1, 0};
  return out;
}

ros::CompressedImage image_of(const Frame& f, const FlightClock& clock) {
  ros::CompressedImage out{{clock.stamp(f.t_s), kOpticalFrame}, "jpeg", {}};
  std::ifstream in(f.file, std::ios::binary);
  out.data.assign(std::istreambuf_iterator<char>(in), {});
  return out;
}

}  // namespace

std::vector<Topic> picture_topics(const evaluation::RunRecord& run, const FlightClock& clock,
                                  std::vector<std::string>& problems) {
  if (!fs::exists(run.directory / "frames.csv")) return {};
  auto frames = std::make_shared<const std::vector<Frame>>(frames_of(run.directory, problems));
  auto pictures = std::make_shared<const std::vector<Frame>>(with_pictures(*frames, problems));
  std::vector<Topic> topics;
  topics.push_back(static_transform(clock, kCameraFrame, kOpticalFrame, T_camera_optical()));
  topics.push_back(topic_of<ros::TFMessage>("/tf", clock, frames->size(), [frames, clock](std::size_t i) {
    const Frame& f = (*frames)[i];
    return std::pair(
        f.t_s,
        ros::TFMessage{{{{clock.stamp(f.t_s), kMapFrame}, kCameraFrame, ros::transform(f.T_world_camera)}}});
  }));
  topics.push_back(topic_of<ros::CameraInfo>("/camera/camera_info", clock, pictures->size(),
                                             [pictures, clock](std::size_t i) {
                                               const Frame& f = (*pictures)[i];
                                               return std::pair(f.t_s, info_of(f, clock));
                                             }));
  topics.push_back(topic_of<ros::CompressedImage>("/camera/image_raw/compressed", clock, pictures->size(),
                                                  [pictures, clock](std::size_t i) {
                                                    const Frame& f = (*pictures)[i];
                                                    return std::pair(f.t_s, image_of(f, clock));
                                                  }));
  return topics;
}

}  // namespace karst::mcap
