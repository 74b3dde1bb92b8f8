#include "core_stack/mapping/region/region_keys.h"

#include <boost/property_tree/ptree.hpp>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"

namespace karst::core {
namespace {

constexpr const char* kGrammar =
    "expected \"box X Y Z X Y Z\" or \"polygon X Y X Y X Y ... [from LOW] [to HIGH]\", in metres";
constexpr double kFarthest_m = 1e5;       // of a coordinate; no cave is so long
constexpr std::size_t kMaxCorners = 200;  // each costs time with each question

std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 60;
  return text.size() <= kMost ? text : text.substr(0, kMost).append("...");
}

/// The words of one body, read from first to last.
class Body {
 public:
  Body(const std::string& source, const std::string& key, const std::string& text)
      : source_(source), key_(key), text_(text) {
    std::istringstream in(text);
    for (std::string word; in >> word;) words_.push_back(word);
  }

  Prism read() {
    if (words_.empty()) refuse(kGrammar);
    const std::string kind = words_[next_++];
    Prism prism;
    if (kind == "box") {
      const Vec3 a = corner(), b = corner();
      prism = box(a, b);
    } else if (kind == "polygon") {
      while (next_ < words_.size() && words_[next_] != "from" && words_[next_] != "to") {
        if (prism.outline.size() == kMaxCorners)
          refuse("has more than " + std::to_string(kMaxCorners) + " corners");
        const double x = number();
        prism.outline.emplace_back(x, number());
      }
      // A ring of a survey ends with the corner that it began with.
      if (prism.outline.size() > 3 && prism.outline.back() == prism.outline.front()) prism.outline.pop_back();
      read_heights(prism);
    } else {
      refuse(kGrammar);
    }
    if (next_ < words_.size()) refuse("\"" + shortened(words_[next_]) + "\" is one word too many");
    if (const auto flaw = flaw_of(prism)) refuse(*flaw);
    return prism;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(source_, key_, why + "; got \"" + shortened(text_) + "\"");
  }

  double number() {
    if (next_ == words_.size()) refuse("a number is missing at its end");
    const std::string& word = words_[next_++];
    double v = 0;
    const char* const end = word.data() + word.size();
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';  // from_chars takes none
    const auto [stop, error] = std::from_chars(word.data() + (plus ? 1 : 0), end, v);
    if (error != std::errc() || stop != end || !(std::abs(v) <= kFarthest_m))
      refuse("\"" + shortened(word) + "\" is no number of metres");
    return v;
  }

  Vec3 corner() {
    const double x = number(), y = number();
    return {x, y, number()};
  }

  void read_heights(Prism& prism) {
    if (next_ < words_.size() && words_[next_] == "from") {
      ++next_;
      prism.low_m = number();
    }
    if (next_ < words_.size() && words_[next_] == "to") {
      ++next_;
      prism.high_m = number();
    }
  }

  const std::string &source_, &key_, &text_;
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

Prism prism_of(const std::string& source, const std::string& key, const std::string& text) {
  return Body(source, key, text).read();
}

}  // namespace

void describe(OptionTable& t, RegionKeys& k) {
  t.add("keep_in", k.keep_in, {},
        "the vehicle stays inside: \"box X Y Z X Y Z\" (two opposite corners) or \"polygon X Y X Y X Y ... "
        "[from LOW] [to HIGH]\", world frame, m; empty: everywhere");
  t.add("keep_out", k.keep_out, {}, "it stays out of each of these: as keep_in, with | between several");
  t.add("max_home_distance", k.max_home_m, "m", 0, 1e5,
        "it flies no farther from home than this length of path; 0: as far as the battery allows");
  t.add("margin", k.margin_m, "m", 0.2, 5, "paths keep this distance from the border beyond their clearance");
}

std::shared_ptr<const FlightRegion> region_of(const std::string& source, const RegionKeys& keys) {
  if (keys.empty()) return nullptr;
  FlightRegion::Limits limits;
  limits.margin_m = keys.margin_m;
  if (!keys.keep_in.empty()) limits.keep_in = prism_of(source, "region.keep_in", keys.keep_in);
  std::string_view left = keys.keep_out;
  while (!keys.keep_out.empty()) {
    const std::size_t bar = left.find('|');
    limits.keep_out.push_back(prism_of(source, "region.keep_out", std::string(left.substr(0, bar))));
    if (bar == std::string_view::npos) break;
    left.remove_prefix(bar + 1);
  }
  if (keys.max_home_m > 0) limits.max_home_m = keys.max_home_m;
  return std::make_shared<const FlightRegion>(std::move(limits));
}

std::shared_ptr<const FlightRegion> region_in(const std::string& source,
                                              const boost::property_tree::ptree& mission) {
  const auto section = mission.get_child_optional("region");
  if (!section) return nullptr;
  RegionKeys keys;
  OptionTable table;
  table.section("region", keys);
  boost::property_tree::ptree only;
  only.put_child("region", *section);
  table.read(source, only);
  return region_of(source, keys);
}

}  // namespace karst::core
