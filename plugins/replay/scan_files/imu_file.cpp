#include "plugins/replay/scan_files/imu_file.h"

#include <cctype>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "plugins/replay/scan_files/text_numbers.h"

namespace karst::replay {

using core::InputError;

ImuFile::ImuFile(const std::string& path, const std::string& columns, core::TimeNs unit_ns,
                 const core::Quat& R_body_imu)
    : path_(path),
      in_(core::open_input(path, core::kMaxDataFileBytes)),
      unit_ns_(unit_ns),
      R_body_imu_(R_body_imu) {
  constexpr std::array kNames = {"t", "ax", "ay", "az", "wx", "wy", "wz"};
  std::array<bool, 7> found{};
  std::string_view rest = columns;
  for (auto name = next_word(rest); !name.empty(); name = next_word(rest), ++columns_)
    for (std::size_t i = 0; i < kNames.size(); ++i)
      if (name == kNames[i]) {
        at_[i] = columns_;
        found[i] = true;
      }
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (!found[i]) throw InputError(path, "imu.columns", std::string("no column is called ") + kNames[i]);
}

std::optional<core::ImuSample> ImuFile::next() {
  for (std::string text; std::getline(in_, text);) {
    ++line_;
    if (!text.empty() && text.back() == '\r') text.pop_back();
    std::string_view rest = text;
    std::vector<std::string_view> words;
    for (auto w = next_word(rest); !w.empty(); w = next_word(rest)) words.push_back(w);
    if (words.empty() || words[0][0] == '#' || std::isalpha(static_cast<unsigned char>(words[0][0])))
      continue;
    const std::string place = "line " + std::to_string(line_);
    if (words.size() < columns_) throw InputError(path_, place, "has fewer columns than imu.columns");
    const auto stamp = parse_time(words[at_[0]], unit_ns_);
    std::array<double, 6> v{};
    bool good = stamp.has_value();
    for (std::size_t i = 0; i < v.size(); ++i)
      good = good && to_number(words[at_[i + 1]], v[i]) && std::isfinite(v[i]);
    if (!good) throw InputError(path_, place, "is not the numbers that imu.columns asks for");
    if (last_ && *stamp < *last_) throw InputError(path_, place, "goes back in time");
    last_ = stamp;
    return core::ImuSample{*stamp, R_body_imu_ * core::Vec3(v[0], v[1], v[2]),
                           R_body_imu_ * core::Vec3(v[3], v[4], v[5])};
  }
  return std::nullopt;
}

}  // namespace karst::replay
