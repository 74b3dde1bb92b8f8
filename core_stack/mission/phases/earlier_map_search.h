// Looks for the vehicle's place in the map of an earlier flight, from its own map, and takes the earlier
// map's cells in. Docs: docs/earlier_map.md.
//
//   first hover: what is seen is copied -> located in the earlier map -> found: its cells are taken in
//                       ^                        -> not found: later again, from where it is then; if the
//                                                   mission requires it, from the first hover
//
// The search is a job of the lane for registration: neither mapping nor localization waits for it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core_stack/mapping/prior/earlier_map.h"
#include "core_stack/mission/onboard/onboard.h"

namespace karst::core {

class EarlierMapSearch {
 public:
  explicit EarlierMapSearch(Onboard& onboard);

  /// Ten times a second from the first hover until the vehicle turns back.
  void step();
  /// The vehicle turns back: what is found from now on is not taken in.
  void end();
  /// The battery or the time allowed only just suffices to land: after its first answer it hovers no longer
  /// for its place.
  void hurry();
  /// Whether exploration waits for it: there is an earlier map, and the first answer is still to come, or the
  /// cells that it led to; if the mission requires its place, until it is found or the search time is over.
  bool undecided() const;
  /// Why the vehicle may not explore: the mission requires its place in the earlier map, and it was not found
  /// from the first hover within the search time. "" if it may.
  const std::string& refusal() const { return refusal_; }

 private:
  enum class State { none, first, later, takes_in, over };
  struct Found {
    MapRegistration registration;
    std::shared_ptr<const std::vector<CellValue>> cells;  // in the frame of the flight, if it is trusted
    double free_m3 = 0;                                   // of these
  };
  void look();
  void locate(std::shared_ptr<const VoxelMap> seen);
  void on_answer(const Found& found);
  void take_in(std::shared_ptr<const std::vector<CellValue>> cells, std::size_t begin);
  void look_later(const std::string& reason);
  void give_up();
  bool required() const { return onboard_.options.earlier.required; }
  TimeNs search_time() const { return from_seconds(onboard_.options.earlier.search_time_s); }

  Onboard& onboard_;
  State state_;
  bool running_ = false;
  int attempts_ = 0;
  TimeNs begun_ = 0, next_ = 0;
  TimeNs pause_;
  std::string refusal_, last_reason_;
};

}  // namespace karst::core
