#include "sdk/campaign/paper/plot_axis.h"

#include <algorithm>
#include <cmath>

#include "sdk/campaign/paper/printed_figure.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {

PlotAxis number_axis(double least, double most, int ticks, const std::string& label) {
  if (!(most > least)) most = least + 1;
  const double rough = (most - least) / ticks, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double times : {5.0, 2.0, 1.0})
    if (rough <= times * power) step = times * power;
  constexpr double kSlack = 1e-9;  // what is a multiple but for rounding is one
  const auto first = static_cast<long>(std::floor(least / step + kSlack)),
             last = static_cast<long>(std::ceil(most / step - kSlack));
  PlotAxis axis{static_cast<double>(first) * step, static_cast<double>(last) * step, {}, label};
  for (long k = first; k <= last; ++k) {
    const double at = static_cast<double>(k) * step;
    axis.ticks.push_back({at, printed_number(at, decimals_for(step, 1))});
  }
  return axis;
}

PlotAxis name_axis(const std::vector<std::string>& names) {
  const auto rows = static_cast<double>(std::max<std::size_t>(names.size(), 1));
  PlotAxis axis{rows - 0.5, -0.5, {}, ""};
  for (std::size_t i = 0; i < names.size(); ++i) axis.ticks.push_back({static_cast<double>(i), names[i]});
  return axis;
}

}  // namespace karst::campaign
