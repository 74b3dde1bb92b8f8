// Surveys within surveys, and the names of their stations.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sdk/survey/readings.h"

namespace karst::survey {

constexpr std::size_t kMaxSurveyDepth = 256;
constexpr std::size_t kMaxStationName = 1024;  // bytes; as many again for the surveys around it

class SurveyTree {
 public:
  /// The survey `name` within `parent`; a new one if there is none yet.
  std::uint32_t enter(std::uint32_t parent, const std::string& name);
  std::uint32_t parent(std::uint32_t survey) const { return surveys_[survey].parent; }
  /// Of the names of a survey and those around it.
  std::size_t name_bytes(std::uint32_t survey) const { return surveys_[survey].prefix.size(); }
  /// "inner.outer" as seen from a survey, none if there is no such survey.
  std::optional<std::uint32_t> find(std::uint32_t from, std::string_view path) const;
  /// A name in full, outermost survey first.
  std::string full_name(std::uint32_t survey, const std::string& name) const;

 private:
  struct Node {
    std::uint32_t parent = 0;
    std::string prefix;  // "outer.inner."
  };
  std::vector<Node> surveys_{1};  // the first one has no name
  std::unordered_map<std::string, std::uint32_t> by_name_;
};

/// Names as the files use them. One with '@' may name a survey that comes later, so it is looked up at the
/// end.
class StationNames {
 public:
  /// Its number until resolve(). A station is defined by a leg or a fix, not by being mentioned.
  std::uint32_t number(std::uint32_t survey, const std::string& word, const Source& source, bool defines);
  /// A new station without a name.
  std::uint32_t anonymous(const Source& source);
  bool is_anonymous(std::uint32_t number) const { return names_[number].anonymous; }

  struct Resolved {
    std::vector<ReadStation> stations;
    std::vector<bool> defined;          // for each station
    std::vector<std::uint32_t> number;  // of each name: its station
  };
  /// Throws core::InputError at the first name whose survey there is not, or that is none.
  Resolved resolve(const SurveyTree& tree, const SourceLog& log);

 private:
  struct Name {
    std::uint32_t survey = 0;
    std::string name, within;  // within: what stands behind '@'
    Source source;
    bool defined = false, anonymous = false;
  };
  std::vector<Name> names_;
  std::unordered_map<std::string, std::uint32_t> by_word_;
};

}  // namespace karst::survey
