#include "sdk/survey/err_file.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <system_error>

#include "core_stack/common/input_file.h"

namespace karst::survey {
namespace {

/// The stations of "1 - 2 = 3 - 4". cavern writes "<fixed point>" for some, and nothing for a station without
/// a name.
void set_stations(const std::string& text, Loops::Traverse& traverse) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min({text.find(" - ", begin), text.find(" = ", begin), text.size()});
    names.push_back(text.substr(begin, end - begin));
    begin = end + 3;
  }
  const auto end_name = [](const std::string& name) {
    return name.empty() ? "a station without a name" : name;
  };
  traverse.from = end_name(names.front());
  traverse.to = end_name(names.back());
  std::erase_if(names, [](const std::string& name) { return name.empty() || name.starts_with('<'); });
  traverse.stations = std::move(names);
}

}  // namespace

std::vector<Loops::Traverse> read_err_file(const std::filesystem::path& file) {
  std::vector<Loops::Traverse> traverses;
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return traverses;
  std::ifstream in = core::open_input(file.string(), core::kMaxRecordFileBytes);
  // Four lines and an empty one for each:
  //   1 - 2 - 3 - 1
  //   Original length  34.00m (  3 legs), moved   0.19m ( 0.06m/leg). Error   0.55%
  //   0.684427
  //   H: 0.909431 V: 0.000000
  std::string stations, text;
  while (std::getline(in, stations)) {
    if (stations.empty()) continue;
    if (!std::getline(in, text)) break;
    Loops::Traverse traverse;
    set_stations(stations, traverse);
    const int read = std::sscanf(text.c_str(), "Original length %lfm (%zu legs), moved %lfm",
                                 &traverse.length_m,  // NOLINT
                                 &traverse.legs, &traverse.error_m);
    double sigmas = 0;
    if (std::getline(in, text) && std::sscanf(text.c_str(), "%lf", &sigmas) == 1)
      traverse.sigmas = sigmas;  // NOLINT
    while (std::getline(in, text) && !text.empty()) {
    }
    if (read != 3) continue;              // a traverse of equates alone has no length
    if (traverse.error_m == 0) continue;  // one that is on no loop is listed, too, and never moves
    if (traverse.length_m > 0) traverse.error_percent = 100 * traverse.error_m / traverse.length_m;
    traverses.push_back(std::move(traverse));
  }
  std::stable_sort(traverses.begin(), traverses.end(),
                   [](const auto& a, const auto& b) { return a.error_m > b.error_m; });
  return traverses;
}

}  // namespace karst::survey
