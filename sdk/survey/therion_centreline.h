// One `centreline ... endcentreline`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sdk/survey/survey_tree.h"
#include "sdk/survey/therion_data.h"
#include "sdk/survey/therion_settings.h"

namespace karst::survey {

/// What is said about a station, which may be named before it is measured.
struct StationRemark {
  std::uint32_t station = 0;
  std::string comment;
  bool entrance = false, continuation = false;
  Source source;
};
/// `extend WHERE FROM TO`: of one leg.
struct ExtendOfLeg {
  std::uint32_t from = 0, to = 0;
  Extend extend = Extend::normal;
};
/// What the files say beside the readings.
struct TherionRemarks {
  std::vector<StationRemark> stations;
  std::vector<ExtendOfLeg> extends;
};

class Centreline {
 public:
  Centreline(Readings& readings, StationNames& names, TherionRemarks& remarks)
      : readings_(readings), names_(names), remarks_(remarks), rows_(readings, names) {}

  /// `outer`: the declinations of the survey around it.
  void begin(std::uint32_t survey, const Declinations& outer, const Source& source);
  /// Carries out a command or takes a row of readings. False: the centreline ends here.
  bool line(const std::vector<std::string>& words, const Source& source);
  /// `equate`, which also stands outside of centrelines, where no names are completed.
  void equate(const std::vector<std::string>& words, const Source& source, std::uint32_t survey);
  const Source& began() const { return began_; }

 private:
  void end();
  bool command(const std::vector<std::string>& words);
  void declination(const std::vector<std::string>& words);
  void date(const std::vector<std::string>& words);
  void data(const std::vector<std::string>& words);
  void fix(const std::vector<std::string>& words);
  void station(const std::vector<std::string>& words);
  void extend(const std::vector<std::string>& words);
  void group();
  void end_group();
  /// Of a station's name as it stands in a command.
  std::uint32_t number_of_station(const std::string& word, std::uint32_t survey, bool defines) const;
  void apply(const Refusal& refusal) const;
  [[noreturn]] void refuse(const std::string& reason) const;

  struct Group {
    Settings settings;
    DataFormat format;
  };
  Readings& readings_;
  StationNames& names_;
  TherionRemarks& remarks_;
  DataRows rows_;
  std::vector<Group> groups_{1};  // the last one holds
  Declinations declinations_;
  std::optional<YearRange> years_;
  std::size_t first_conditions_ = 0;
  std::uint32_t survey_ = 0;
  Source source_, began_;
};

}  // namespace karst::survey
