#include "sdk/survey/dump3d.h"

#include <array>
#include <charconv>
#include <string_view>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/printable.h"

namespace karst::survey {
namespace {

/// Takes word after word off a line.
class Words {
 public:
  explicit Words(std::string_view rest) : rest_(rest) {}

  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  std::optional<double> number() {
    const std::string_view w = word();
    double value = 0;
    const auto [end, failed] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (failed != std::errc() || end != w.data() + w.size() || !(std::abs(value) < 1e12)) return std::nullopt;
    return value;
  }
  std::optional<core::Vec3> place() {
    const auto x = number(), y = number(), z = number();
    if (!x || !y || !z) return std::nullopt;
    return core::Vec3(*x, *y, *z);
  }
  /// What stands in [ ], which may hold spaces.
  std::optional<std::string> bracketed() {
    const std::size_t begin = rest_.find('['), end = rest_.rfind(']');
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) return std::nullopt;
    std::string name(rest_.substr(begin + 1, end - begin - 1));
    rest_.remove_prefix(end + 1);
    return name;
  }

 private:
  std::string_view rest_;
};

std::optional<Style> style_of_word(std::string_view word) {
  if (word == "STYLE=NORMAL") return Style::normal;
  if (word == "STYLE=DIVING") return Style::diving;
  if (word == "STYLE=CARTESIAN") return Style::cartesian;
  if (word == "STYLE=CYLPOLAR") return Style::cylpolar;
  if (word == "STYLE=NOSURVEY") return Style::no_survey;
  return std::nullopt;
}

class Dump3dReader {
 public:
  Dump3d read(std::istream& in, const std::string& shown_as) {
    std::string text;
    for (std::size_t line = 1; std::getline(in, text); ++line) {
      if (text == "EXTENDED ELEVATION")
        throw core::InputError(shown_as, "",
                               "is an extended elevation, as Survex's `extend` makes: a drawing of the cave "
                               "unrolled into a plane. Give the .3d file that it was made of");
      if (!take(text))
        throw core::InputError(shown_as, "line " + std::to_string(line) + " of what dump3d prints of it",
                               "cannot be read: " + core::printable(text.substr(0, 200)));
    }
    return std::move(dump_);
  }

 private:
  bool take(const std::string& text) {
    Words words(text);
    const std::string_view kind = words.word();
    if (kind == "NODE") return node(words);
    if (kind == "MOVE") return move(words);
    if (kind == "LINE") return line(words);
    if (kind == "XSECT") return section(words);
    if (kind == "XSECT_END") ++series_;
    if (kind == "TITLE" && text.size() > 8) dump_.title = text.substr(7, text.size() - 8);
    if (kind == "SEPARATOR" && text.size() >= 12) dump_.separator = text[11];
    return true;
  }

  bool node(Words& words) {
    const auto place = words.place();
    const auto name = words.bracketed();
    if (!place || !name) return false;
    Dump3d::Node& node = dump_.nodes.emplace_back();
    node.position_m = *place;
    node.name = *name;
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
      if (word == "SURFACE") node.surface = true;
      if (word == "UNDERGROUND") node.underground = true;
      if (word == "ENTRANCE") node.entrance = true;
      if (word == "FIXED") node.fixed = true;
      if (word == "WALL") node.wall = true;
      if (word == "ANON") node.name.clear();
    }
    return true;
  }

  bool move(Words& words) {
    const auto place = words.place();
    if (!place) return false;
    at_ = *place;
    ++run_;
    return true;
  }

  bool line(Words& words) {
    const auto place = words.place();
    const auto label = words.bracketed();
    if (!place || !label) return false;
    Dump3d::Line& line = dump_.lines.emplace_back();
    line.from_m = at_;
    line.to_m = at_ = *place;
    line.run = run_;
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
      if (word == "SURFACE") line.surface = true;
      if (word == "DUPLICATE") line.duplicate = true;
      if (word == "SPLAY") line.splay = true;
      if (const auto style = style_of_word(word)) line.style = style;
    }
    return true;
  }

  bool section(Words& words) {
    Dump3d::CrossSection section;
    Dimensions& d = section.dimensions;
    for (std::optional<double>* side : {&d.left_m, &d.right_m, &d.up_m, &d.down_m}) {
      const auto value = words.number();
      if (!value) return false;
      if (*value >= 0) *side = value;  // omitted ones are -0.01
    }
    const auto name = words.bracketed();
    if (!name) return false;
    section.station = *name;
    section.series = series_;
    dump_.sections.push_back(std::move(section));
    return true;
  }

  Dump3d dump_;
  core::Vec3 at_ = core::Vec3::Zero();
  std::uint32_t run_ = 0, series_ = 1;
};

}  // namespace

Dump3d read_dump3d(const std::filesystem::path& text, const std::string& shown_as) {
  std::ifstream in = core::open_input(text.string(), 8192 * core::kMiB);
  return Dump3dReader().read(in, shown_as);
}

}  // namespace karst::survey
