#include "sdk/campaign/verdict/figure_words.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core_stack/common/format_text.h"

namespace karst::campaign {
namespace {

/// The phrase for one figure; figures without a phrase are named.
struct Phrase {
  std::string_view metric;
  std::string_view more, less;  // "A ... than B" if A has more of it, and if it has less
  std::string_view subject;     // "no difference shown in ..."
};
constexpr std::array kPhrases = {
    Phrase{"completed", "completes more flights than", "completes fewer flights than", "flights completed"},
    Phrase{"contacts", "touches rock more often than", "touches rock less often than", "contacts"},
    Phrase{"path_length_m", "flies farther than", "flies less far than", "path length"},
    Phrase{"mean_speed_mps", "flies faster than", "flies slower than", "mean speed"},
    Phrase{"exploring_speed_mps", "explores at a higher speed than", "explores at a lower speed than",
           "exploring speed"},
    Phrase{"standing_share", "stands more than", "stands less than", "standing"},
    Phrase{"energy_wh", "draws more energy than", "draws less energy than", "energy"},
    Phrase{"explored_volume_m3", "explores more than", "explores less than", "explored volume"},
    Phrase{"coverage", "ends with more coverage than", "ends with less coverage than", "final coverage"},
    Phrase{"coverage_auc", "covers more, averaged over the flight, than",
           "covers less, averaged over the flight, than", "coverage averaged over the flight"},
    Phrase{"restricted_t50_s", "covers 50 % later than", "covers 50 % sooner than", "time to 50 % coverage"},
    Phrase{"restricted_t90_s", "covers 90 % later than", "covers 90 % sooner than", "time to 90 % coverage"},
    Phrase{"restricted_t95_s", "covers 95 % later than", "covers 95 % sooner than", "time to 95 % coverage"},
    Phrase{"surface_seen", "sees more of the surface than", "sees less of the surface than", "surface seen"},
    Phrase{"surface_imaged", "takes pictures of more of the surface than",
           "takes pictures of less of the surface than", "surface in pictures"},
    Phrase{"depth_m", "comes deeper than", "comes less deep than", "depth reached"},
    Phrase{"objects_found", "finds more objects than", "finds fewer objects than", "objects found"},
    Phrase{"objects_reported", "reports more objects than", "reports fewer objects than", "objects reported"},
    Phrase{"volume_per_wh_m3", "explores more for its energy than", "explores less for its energy than",
           "volume explored for each watt-hour"},
    Phrase{"min_clearance_m", "keeps farther from rock than", "comes nearer to rock than", "least clearance"},
};

const Phrase* phrase_of(std::string_view metric) {
  const auto p = std::find_if(kPhrases.begin(), kPhrases.end(), [&](auto& k) { return k.metric == metric; });
  return p == kPhrases.end() ? nullptr : p;
}

}  // namespace

std::string subject_of(const evaluation::MetricDefinition& d) {
  const Phrase* p = phrase_of(d.name);
  return std::string(p ? p->subject : d.name);
}

std::string verb_of(const evaluation::MetricDefinition& d, bool more) {
  if (const Phrase* p = phrase_of(d.name)) return std::string(more ? p->more : p->less);
  return std::string(more ? "has more " : "has less ") + std::string(d.name) + " than";
}

bool is_fraction(const evaluation::MetricDefinition& d) { return d.unit.empty() && d.most == 1; }

std::span<const std::string_view> headline_figures() {
  static constexpr std::array<std::string_view, 6> kNames = {
      "coverage_auc", "coverage", "restricted_t50_s", "restricted_t90_s", "path_length_m", "contacts"};
  return kNames;
}

int decimals_for(double scale, int digits) {
  const double magnitude = scale > 0 ? std::floor(std::log10(scale)) : 0;
  return std::clamp(digits - 1 - static_cast<int>(magnitude), 0, 6);
}

std::string fixed_text(double v, int decimals) {
  const std::string text = core::format_text("%.*f", decimals, v);
  const std::string_view zero("-0.000000", static_cast<std::size_t>(decimals ? decimals + 3 : 2));
  return text == zero ? text.substr(1) : text;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace karst::campaign
