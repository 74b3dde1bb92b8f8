#include "core_stack/mission/recording/picture_file.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <unistd.h>
#include <cmath>
#include <filesystem>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

RgbFrame smooth_frame(int width, int height) {
  auto model = std::make_shared<RgbCameraModel>();
  model->camera.width = width, model->camera.height = height;
  RgbFrame frame{0, model, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int v : {x * 255 / width, y * 255 / height, 128})
        frame.rgb.push_back(static_cast<std::uint8_t>(v));
  return frame;
}

TEST(PictureFile, ReadsBackAsThePictureItWas) {
  const RgbFrame frame = smooth_frame(64, 48);
  const std::vector<std::uint8_t> bytes = jpeg_of(frame);
  EXPECT_EQ(bytes, jpeg_of(frame));
  void* reader = tjInitDecompress();
  std::vector<std::uint8_t> back(frame.rgb.size());
  ASSERT_EQ(tjDecompress2(reader, bytes.data(), bytes.size(), back.data(), 64, 0, 48, TJPF_RGB, 0), 0);
  tjDestroy(reader);
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_NEAR(back[i], frame.rgb[i], 8);
}

TEST(PictureFile, APictureThatDoesNotFitItsCameraIsRefused) {
  RgbFrame frame = smooth_frame(64, 48);
  frame.rgb.pop_back();
  EXPECT_THROW(jpeg_of(frame), std::runtime_error);
  EXPECT_THROW(jpeg_of(RgbFrame{}), std::runtime_error);
}

TEST(PictureFile, AFolderThatCannotBeIsAnErrorThatNamesTheFile) {
  const RgbFrame frame = smooth_frame(16, 16);
  try {
    write_jpeg("/proc/none/frames/1.jpg", frame);
    FAIL() << "it was written";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/proc/none/frames/1.jpg"), std::string::npos);
  }
  const auto path =
      std::filesystem::temp_directory_path() / ("karst_picture_" + std::to_string(getpid())) / "a" / "1.jpg";
  write_jpeg(path, frame);
  EXPECT_EQ(std::filesystem::file_size(path), jpeg_of(frame).size());
  std::filesystem::remove_all(path.parent_path().parent_path());
}

}  // namespace
}  // namespace karst::core
