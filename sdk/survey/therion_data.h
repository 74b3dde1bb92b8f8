// The readings of a centreline: rows in the order that `data` gave, to legs.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sdk/survey/survey_tree.h"
#include "sdk/survey/therion_settings.h"

namespace karst::survey {

/// What `data STYLE COLUMNS...` declares.
struct DataFormat {
  Style style = Style::normal;
  bool dimensions = false;  // of stations, no legs
  std::vector<Column> order = {Column::from, Column::to, Column::length, Column::bearing, Column::gradient};
  bool has(Column column) const;
  bool interleaved() const { return !dimensions && has(Column::station); }
};
Refusal read_format(const std::vector<std::string>& words, DataFormat& format);

class DataRows {
 public:
  DataRows(Readings& readings, StationNames& names) : readings_(readings), names_(names) {}

  void begin(const DataFormat& format);
  /// The next station begins a new run. What the rows before it lack is refused, or noted.
  void interrupt();
  /// Takes one line. Throws core::InputError naming it.
  void row(const std::vector<std::string>& words, const Source& source, std::uint32_t survey,
           const Settings& settings);
  /// The next leg does not share conditions with the legs before it.
  void new_conditions() { conditions_fresh_ = false; }

 private:
  struct Row {
    std::uint32_t from = 0, to = 0, station = 0;
    std::array<double, kColumns> value;
    std::array<Dimensions, 2> dimensions;  // at from and to; of rows of a station: the second
    bool backwards = false;
    bool of_stations = false;  // counters and depths were read at stations, not along a leg
    Source source;
  };
  void take(Column column, const std::string& word, Row& row);
  void take_dimension(Column column, const std::string& word, Row& row);
  std::uint32_t station_of(const std::string& word, bool defines);
  void end_of_station_row();
  void end_of_row();
  void leg(const Row& row, std::uint32_t from, std::uint32_t to);
  Reading reading_of(const Row& row) const;
  void set_length(const Row& row, Reading& reading) const;
  void set_bearing(const Row& row, Reading& reading) const;
  void set_inclination(const Row& row, Reading& reading) const;
  void set_rise(const Row& row, Reading& reading) const;
  double change_m(const Row& row, Quantity quantity, Column first, Column second) const;
  void add(Reading reading, const Row& row);
  void add_dimensions(const Row& row);
  std::uint32_t conditions_now();
  [[noreturn]] void refuse(const std::string& reason) const;

  Readings& readings_;
  StationNames& names_;
  DataFormat format_;
  std::size_t at_ = 0;  // column of the order
  Row row_;
  std::optional<Row> before_;  // of interleaved data: the station before, with the readings behind it
  std::optional<std::uint32_t> last_to_;
  std::uint32_t run_ = 0;
  bool conditions_fresh_ = false;
  // Those of the line at hand.
  const Settings* settings_ = nullptr;
  std::uint32_t survey_ = 0;
  Source source_;
};

}  // namespace karst::survey
