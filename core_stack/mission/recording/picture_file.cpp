#include "core_stack/mission/recording/picture_file.h"

#include <turbojpeg.h>

#include <fstream>
#include <memory>
#include <stdexcept>

#include "core_stack/common/error.h"

namespace karst::core {

std::vector<std::uint8_t> jpeg_of(const RgbFrame& frame) {
  constexpr int kQuality = 90;
  if (!frame.model) throw std::runtime_error("a picture without a camera");
  const int width = frame.model->camera.width, height = frame.model->camera.height;
  if (width <= 0 || height <= 0 ||
      frame.rgb.size() != std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::runtime_error("a picture whose size is not its camera's");
  const std::unique_ptr<void, int (*)(void*)> coder(tjInitCompress(), &tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = coder ? tjCompress2(coder.get(), frame.rgb.data(), width, 0, height, TJPF_RGB, &bytes,
                                         &size, TJSAMP_444, kQuality, TJFLAG_ACCURATEDCT)
                           : -1;
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owned(bytes, &tjFree);
  if (failed) throw std::runtime_error(std::string("JPEG: ") + tjGetErrorStr2(coder.get()));
  return {bytes, bytes + size};
}

void write_jpeg(const std::filesystem::path& path, const RgbFrame& frame) {
  const std::vector<std::uint8_t> bytes = jpeg_of(frame);
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);  // what is wrong shows below
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw InputError(path.string(), "", "cannot be written; is the disk full?");
}

}  // namespace karst::core
