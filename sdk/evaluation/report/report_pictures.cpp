#include "sdk/evaluation/report/report_pictures.h"

#include <turbojpeg.h>

#include <array>

#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>

#include "core_stack/common/geometry.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/rounded.h"
#include "sdk/evaluation/page/base64.h"
#include "sdk/evaluation/record/table.h"

namespace karst::evaluation {
namespace {

constexpr std::size_t kMax = 240;
constexpr int kWidth = 240, kQuality = 60;

using core::to_thousandths;
using Coder = std::unique_ptr<void, int (*)(void*)>;

void require(bool fine, const Coder& coder) {
  if (!fine) throw std::runtime_error(tjGetErrorStr2(coder.get()));
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
  const std::string bytes = core::read_input(file, core::kMaxTextFileBytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::vector<std::uint8_t> thumbnail(const std::vector<std::uint8_t>& jpeg, int width) {
  const Coder reader(tjInitDecompress(), &tjDestroy), writer(tjInitCompress(), &tjDestroy);
  int full_width = 0, full_height = 0, sampling = 0, colours = 0;
  require(tjDecompressHeader3(reader.get(), jpeg.data(), jpeg.size(), &full_width, &full_height, &sampling,
                              &colours) == 0,
          reader);
  // The decoder can scale by eighths.
  int eighths = 8;
  while (eighths > 1 && TJSCALED(full_width, (tjscalingfactor{eighths, 8})) > width) --eighths;
  const tjscalingfactor scale{eighths, 8};
  const int w = TJSCALED(full_width, scale), h = TJSCALED(full_height, scale);
  std::vector<std::uint8_t> rgb(std::size_t{3} * static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  require(tjDecompress2(reader.get(), jpeg.data(), jpeg.size(), rgb.data(), w, 0, h, TJPF_RGB,
                        TJFLAG_ACCURATEDCT) == 0,
          reader);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(writer.get(), rgb.data(), w, 0, h, TJPF_RGB, &out, &size, TJSAMP_420,
                                 kQuality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owned(out, &tjFree);
  require(failed == 0, writer);
  return {out, out + size};
}

nlohmann::ordered_json report_pictures(const std::filesystem::path& run_dir,
                                       std::vector<std::string>& problems) {
  const Table table = read_table(run_dir / "frames.csv", {"file"}, problems);
  const auto files = table.text.find("file");
  const auto* t_s = table.column("stamp_s");
  std::array<const std::vector<double>*, 7> pose{};
  const std::array<const char*, 7> names{"x", "y", "z", "qx", "qy", "qz", "qw"};
  bool whole = t_s && files != table.text.end();
  for (std::size_t i = 0; i < pose.size(); ++i) whole = (pose[i] = table.column(names[i])) && whole;
  if (!whole) return nullptr;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < table.rows; ++i)
    if (!files->second[i].empty()) kept.push_back(i);
  if (kept.empty()) return nullptr;
  nlohmann::ordered_json pictures = nlohmann::ordered_json::array();
  std::size_t lost = 0;
  const std::size_t shown = std::min(kept.size(), kMax);
  for (std::size_t n = 0; n < shown; ++n) {
    const std::size_t row = kept[n * kept.size() / shown];
    const std::string& file = files->second[row];
    const std::filesystem::path relative(file);
    // Reads no file outside the run directory, whatever frames.csv contains.
    const bool inside = relative.is_relative() && relative.lexically_normal().string().rfind("..", 0) != 0;
    try {
      if (!inside) throw std::runtime_error("leads out of the run directory");
      const std::vector<std::uint8_t> small = thumbnail(bytes_of(run_dir / relative), kWidth);
      const core::Quat q((*pose[6])[row], (*pose[3])[row], (*pose[4])[row], (*pose[5])[row]);
      const core::Vec3 axis = q.normalized() * core::Vec3::UnitX();
      pictures.push_back(
          {{"t", (*t_s)[row]},
           {"file", file},
           {"position",
            {to_thousandths((*pose[0])[row]), to_thousandths((*pose[1])[row]),
             to_thousandths((*pose[2])[row])}},
           {"axis", {to_thousandths(axis.x()), to_thousandths(axis.y()), to_thousandths(axis.z())}},
           {"jpeg", base64(std::as_bytes(std::span(small)))}});
    } catch (const std::runtime_error&) {
      ++lost;
    }
  }
  if (lost > 0)
    problems.push_back("frames: " + std::to_string(lost) + " of " + std::to_string(shown) +
                       " pictures are missing or damaged");
  if (pictures.empty()) return nullptr;
  return {{"taken", kept.size()}, {"shown", std::move(pictures)}};
}

}  // namespace karst::evaluation
