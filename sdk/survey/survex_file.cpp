#include "sdk/survey/survex_file.h"

#include <charconv>
#include <cmath>
#include <fstream>

#include "core_stack/common/format_text.h"
#include "core_stack/common/output_file.h"

namespace karst::survey {
namespace {

constexpr std::uint32_t kNamesEach = 100;

class SurvexWriter {
 public:
  SurvexWriter(const std::string& file, const Readings& readings, const Network& network)
      : out_(core::open_output(file)), readings_(readings), network_(network) {}

  std::vector<Source> write(const std::vector<core::Vec3>& fixes_m) {
    line("*units tape depth dx dy dz metres", {});
    line("*units compass clino degrees", {});
    line("*infer plumbs off", {});
    line("*infer equates off", {});
    for (std::size_t i = 0; i < network_.fixes.size(); ++i)
      fix(readings_.fixes[network_.fixes[i]], fixes_m[i]);
    for (const std::uint32_t i : network_.legs) leg(readings_.legs[i]);
    out_.flush();
    return std::move(sources_);
  }

 private:
  void line(const std::string& text, const Source& source) {
    out_ << text << '\n';
    sources_.push_back(source);
  }
  std::string name(std::uint32_t station) const { return place_name(network_.place[station]); }

  void fix(const Fix& f, const core::Vec3& at) {
    std::string text =
        core::format_text("*fix %s %.4f %.4f %.4f", name(f.station).c_str(), at.x(), at.y(), at.z());
    if (f.sd_m) text += core::format_text(" %.9f %.9f %.9f", f.sd_m->x(), f.sd_m->y(), f.sd_m->z());
    line(text, f.source);
  }

  void deviations(const Conditions& c, const Source& source) {
    const Conditions* before = sd_;
    sd_ = &c;
    const auto of = [](const Conditions& k) {
      return std::tie(k.tape_m, k.compass_deg, k.clino_deg, k.depth_m, k.east_m, k.north_m, k.up_m);
    };
    if (before == nullptr ? of(c) == of(Conditions{}) : of(c) == of(*before)) return;
    line("*sd default", source);
    const auto set = [&](const char* quantity, const std::optional<double>& value, const char* unit) {
      if (value) line(core::format_text("*sd %s %.9f %s", quantity, *value, unit), source);
    };
    set("tape", c.tape_m, "metres");
    set("compass", c.compass_deg, "degrees");
    set("clino", c.clino_deg, "degrees");
    set("depth", c.depth_m, "metres");
    set("dx", c.east_m, "metres");
    set("dy", c.north_m, "metres");
    set("dz", c.up_m, "metres");
  }

  void style(Style style, const Source& source) {
    if (style == Style::topofil) style = Style::normal;
    if (style_ == style) return;
    style_ = style;
    switch (style) {
      case Style::diving:
        return line("*data diving from to tape compass depthchange", source);
      case Style::cylpolar:
        return line("*data cylpolar from to tape compass depthchange", source);
      case Style::cartesian:
        return line("*data cartesian from to easting northing altitude", source);
      case Style::no_survey:
        return line("*data nosurvey from to", source);
      default:
        return line("*data normal from to tape compass clino", source);
    }
  }

  void leg(const Reading& r) {
    deviations(readings_.conditions[r.conditions], r.source);
    style(r.style, r.source);
    std::string text = name(r.from) + ' ' + name(r.to);
    const std::string bearing =
        r.plumbed || std::isnan(r.bearing_deg) ? " -" : core::format_text(" %.9f", r.bearing_deg);
    switch (r.style) {
      case Style::diving:
        // cavern 1.4.4 puts the end of a dive of 10 m without a compass reading 6000 m down: give it one.
        text += core::format_text(" %.6f %.9f %.6f", r.length_m, r.plumbed ? 0 : r.bearing_deg, r.rise_m);
        break;
      case Style::cylpolar:
        text += core::format_text(" %.6f%s %.6f", r.length_m, bearing.c_str(), r.rise_m);
        break;
      case Style::cartesian:
        text += core::format_text(" %.6f %.6f %.6f", r.east_m, r.north_m, r.rise_m);
        break;
      case Style::no_survey:
        break;
      default:
        text += core::format_text(" %.6f", r.length_m);
        text += r.plumbed ? (r.inclination_deg < 0 ? " - down" : " - up")
                          : bearing + core::format_text(" %.9f", r.inclination_deg);
    }
    line(text, r.source);
  }

  std::ofstream out_;
  const Readings& readings_;
  const Network& network_;
  std::vector<Source> sources_;
  std::optional<Style> style_;
  const Conditions* sd_ = nullptr;
};

}  // namespace

std::string place_name(std::uint32_t place) {
  return core::format_text("%u.%u.%u.%u", place / (kNamesEach * kNamesEach * kNamesEach),
                           place / (kNamesEach * kNamesEach) % kNamesEach, place / kNamesEach % kNamesEach,
                           place % kNamesEach);
}

std::optional<std::uint32_t> place_of_name(std::string_view name) {
  std::uint64_t place = 0;
  int parts = 0;
  for (const char* at = name.data(); at < name.data() + name.size(); ++parts) {
    std::uint32_t part = 0;
    const auto [end, failed] = std::from_chars(at, name.data() + name.size(), part);
    if (failed != std::errc() || parts == 4) return std::nullopt;
    if (end < name.data() + name.size() && *end != '.') return std::nullopt;
    place = place * kNamesEach + part;
    at = end + 1;
  }
  if (parts != 4 || place > ~0u) return std::nullopt;
  return static_cast<std::uint32_t>(place);
}

std::vector<Source> write_survex(const std::string& file, const Readings& readings, const Network& network,
                                 const std::vector<core::Vec3>& fixes_m) {
  return SurvexWriter(file, readings, network).write(fixes_m);
}

}  // namespace karst::survey
