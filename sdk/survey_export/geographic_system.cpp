#include "sdk/survey_export/geographic_system.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace karst::survey_export {
namespace {

struct Codes {
  int first, last;
};
constexpr std::array kEpsgDegrees{Codes{4000, 4025}, Codes{4027, 4036}, Codes{4039, 4047}, Codes{4120, 4216},
                                  Codes{4218, 4389}, Codes{4475, 4483}, Codes{4490, 4490}, Codes{4600, 4646},
                                  Codes{4657, 4765}, Codes{4801, 4811}, Codes{4813, 4821}, Codes{4882, 5013},
                                  Codes{5368, 5381}, Codes{6317, 6325}, Codes{7034, 7042}, Codes{7656, 7686},
                                  Codes{7843, 7844}, Codes{7900, 7931}, Codes{8227, 8255}, Codes{8397, 8431},
                                  Codes{8915, 8949}, Codes{8972, 9019}, Codes{9053, 9140}, Codes{9775, 9784}};
constexpr std::array kEsriDegrees{Codes{37001, 37260}, Codes{104000, 104999}};

template <class Ranges>
bool holds(const Ranges& ranges, const std::string& digits) {
  if (digits.empty() || digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string::npos)
    return false;
  const int code = std::stoi(digits);
  return std::any_of(ranges.begin(), ranges.end(),
                     [code](const Codes& c) { return c.first <= code && code <= c.last; });
}

}  // namespace

bool is_geographic(const std::string& system) {
  constexpr std::string_view kEpsg = "EPSG:", kEsri = "ESRI:";
  if (system == "lat-long" || system == "long-lat") return true;
  if (system.starts_with(kEpsg)) return holds(kEpsgDegrees, system.substr(kEpsg.size()));
  return system.starts_with(kEsri) && holds(kEsriDegrees, system.substr(kEsri.size()));
}

}  // namespace karst::survey_export
