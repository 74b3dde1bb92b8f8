#include "sdk/survey/survey_tree.h"

#include "core_stack/common/printable.h"

namespace karst::survey {
namespace {

std::string key_of(std::uint32_t survey, const std::string& word) {
  return std::to_string(survey) + ' ' + word;  // words hold no spaces
}

}  // namespace

std::uint32_t SurveyTree::enter(std::uint32_t parent, const std::string& name) {
  const auto [it, is_new] =
      by_name_.try_emplace(key_of(parent, name), static_cast<std::uint32_t>(surveys_.size()));
  if (is_new) surveys_.push_back({parent, surveys_[parent].prefix + name + "."});
  return it->second;
}

std::optional<std::uint32_t> SurveyTree::find(std::uint32_t from, std::string_view path) const {
  while (!path.empty()) {
    const std::size_t dot = path.rfind('.');
    const std::string_view outer = dot == std::string_view::npos ? path : path.substr(dot + 1);
    const auto it = by_name_.find(key_of(from, std::string(outer)));
    if (it == by_name_.end()) return std::nullopt;
    from = it->second;
    path = dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
  }
  return from;
}

std::string SurveyTree::full_name(std::uint32_t survey, const std::string& name) const {
  return surveys_[survey].prefix + name;
}

std::uint32_t StationNames::number(std::uint32_t survey, const std::string& word, const Source& source,
                                   bool defines) {
  const auto [it, is_new] =
      by_word_.try_emplace(key_of(survey, word), static_cast<std::uint32_t>(names_.size()));
  if (is_new) {
    const std::size_t at = word.find('@');
    names_.push_back({survey, word.substr(0, at), at == std::string::npos ? "" : word.substr(at + 1), source,
                      false, false});
  }
  Name& name = names_[it->second];
  if (defines && !name.defined) {
    name.defined = true;
    name.source = source;
  }
  return it->second;
}

std::uint32_t StationNames::anonymous(const Source& source) {
  names_.push_back({0, "", "", source, true, true});
  return static_cast<std::uint32_t>(names_.size() - 1);
}

StationNames::Resolved StationNames::resolve(const SurveyTree& tree, const SourceLog& log) {
  Resolved resolved;
  const std::size_t count = names_.size();
  std::vector<std::uint32_t> named(count);  // the name without '@' that each one stands for
  for (std::uint32_t i = 0; i < count; ++i) {
    named[i] = i;
    if (names_[i].name.empty() && !names_[i].anonymous)
      throw log.error(names_[i].source,
                      "is no name of a station: '@" + core::printable(names_[i].within) + "'");
    if (names_[i].within.empty()) continue;
    const Name name = names_[i];
    const auto survey = tree.find(name.survey, name.within);
    if (!survey) throw log.error(name.source, "there is no survey " + core::printable(name.within));
    named[i] = number(*survey, name.name, name.source, name.defined);
  }
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> station(names_.size(), kNone);
  for (std::uint32_t i = 0; i < names_.size(); ++i) {
    const Name& name = names_[i];
    if (!name.within.empty()) continue;
    station[i] = static_cast<std::uint32_t>(resolved.stations.size());
    ReadStation& read = resolved.stations.emplace_back();
    read.anonymous = name.anonymous;
    if (!read.anonymous) read.name = tree.full_name(name.survey, name.name);
    read.source = name.source;
    resolved.defined.push_back(name.defined);
  }
  for (std::uint32_t i = 0; i < count; ++i) resolved.number.push_back(station[named[i]]);
  return resolved;
}

}  // namespace karst::survey
