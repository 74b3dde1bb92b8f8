#include "sdk/evaluation/report/report_curve.h"

#include "core_stack/common/rounded.h"
#include "sdk/evaluation/page/decimate.h"

namespace karst::evaluation {
namespace {

constexpr std::size_t kMaxPlotSamples = 1600;

}  // namespace

nlohmann::ordered_json report_curve(const std::vector<double>* t_s, const std::vector<double>* y,
                                    double scale) {
  if (!t_s || !y) return nullptr;
  const Curve c = decimate(*t_s, *y, kMaxPlotSamples);
  if (c.x.empty()) return nullptr;
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < c.x.size(); ++i)
    points.push_back({core::to_thousandths(c.x[i]), core::to_thousandths(scale * c.y[i])});
  return points;
}

}  // namespace karst::evaluation
