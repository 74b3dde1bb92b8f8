#include "core_stack/mission/phases/earlier_map_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core_stack/mission/recording/run_event.h"

namespace karst::core {
namespace {

/// What lies farther off is seen by few rays only.
constexpr double kReach_m = 30;
/// The simulated time of a search: a map of 5000 m^3 takes about so long.
constexpr TimeNs kSearchBudget = 4 * kSecond;
/// Between two searches: the first pause, doubled from one to the next, as what is seen changes less and
/// less.
constexpr TimeNs kFirstPause = 5 * kSecond, kLongestPause = 40 * kSecond;
/// Cells that are taken in by one job, so that no scan waits long for the map.
constexpr std::size_t kCellsAtOnce = 10000;
/// The vehicle hovers no longer for its first answer: a computer may be late.
constexpr TimeNs kFirstWait = 20 * kSecond;

double free_volume_m3(const std::vector<CellValue>& cells, double resolution_m) {
  const auto free =
      std::count_if(cells.begin(), cells.end(), [](const CellValue& c) { return c.log_odds < 0; });
  return static_cast<double>(free) * resolution_m * resolution_m * resolution_m;
}

event::EarlierMap event_of(event::EarlierMapState state, int attempt, const MapRegistration& r) {
  event::EarlierMap e{.state = state, .reason = r.reason, .attempt = attempt};
  if (r.overlay.near() == 0) return e;
  const Pose T_world_earlier = r.T_target_source.inverse();
  e.position = T_world_earlier.position;
  e.heading_rad = heading_of(T_world_earlier.orientation);
  e.overlap = r.overlay.source_overlap();
  e.agreement = r.overlay.agreement();
  e.residual_m = r.overlay.residual_m();
  e.surface_residual_m = r.surface_residual_m;
  e.hold = r.hold;
  e.rival = r.rival;
  return e;
}

}  // namespace

EarlierMapSearch::EarlierMapSearch(Onboard& onboard)
    : onboard_(onboard),
      state_(onboard.options.earlier.map ? State::first : State::none),
      pause_(kFirstPause) {}

bool EarlierMapSearch::undecided() const {
  return state_ == State::first || state_ == State::takes_in || (state_ == State::later && required());
}

void EarlierMapSearch::step() {
  if (state_ != State::first && state_ != State::later) return;
  const TimeNs now = onboard_.now();
  if (begun_ == 0) begun_ = now;
  if (state_ == State::first && now - begun_ > kFirstWait) look_later("the search took longer than 20 s");
  // An answer that is late is waited for; in the hover, no more than 20 s beyond the search time.
  const bool hovers = state_ == State::later && required();
  if (running_ && !(hovers && now - begun_ > search_time() + kFirstWait)) return;
  if (state_ == State::later && now - begun_ > search_time()) return give_up();
  if (now >= next_) look();
}

void EarlierMapSearch::end() {
  if (state_ != State::none) state_ = State::over;
}

void EarlierMapSearch::look() {
  running_ = true;
  ++attempts_;
  onboard_.map.job(
      "surroundings", kMappingBudget,
      [here = onboard_.flight.state().position](Explorer& explorer) {
        return surroundings(explorer.map(), here, kReach_m);
      },
      [this](const std::shared_ptr<const VoxelMap>& seen) { locate(seen); });
}

void EarlierMapSearch::locate(std::shared_ptr<const VoxelMap> seen) {
  auto found = std::make_shared<Found>();
  onboard_.executive.job(
      "earlier map", Lane::registration, kSearchBudget,
      [found, seen = std::move(seen), earlier = onboard_.options.earlier.map,
       options = onboard_.options.map] {
        found->registration = locate_in(*earlier, seen);
        if (!found->registration.trusted) return;
        found->cells = std::make_shared<const std::vector<CellValue>>(
            moved_cells(*earlier, found->registration.T_target_source.inverse(), options));
        found->free_m3 = free_volume_m3(*found->cells, options.resolution_m);
      },
      [this, found] { on_answer(*found); });
}

void EarlierMapSearch::on_answer(const Found& found) {
  const TimeNs now = onboard_.now();
  running_ = false;
  if (state_ == State::over) return;
  if (found.registration.trusted) {
    event::EarlierMap e = event_of(event::EarlierMapState::found, attempts_, found.registration);
    e.free_m3 = found.free_m3;
    onboard_.recorder.write(now, e);
    state_ = State::takes_in;
    return take_in(found.cells, 0);
  }
  onboard_.recorder.write(now, event_of(event::EarlierMapState::not_found, attempts_, found.registration));
  look_later(found.registration.reason);
}

void EarlierMapSearch::look_later(const std::string& reason) {
  last_reason_ = reason;
  state_ = State::later;
  next_ = onboard_.now() + pause_;
  pause_ = std::min(2 * pause_, kLongestPause);
  // It does not hover for a search that would begin too late.
  if (required() && !running_ && next_ - begun_ > search_time()) give_up();
}

/// In parts, one after another; exploration that waits goes on after the last one.
void EarlierMapSearch::take_in(std::shared_ptr<const std::vector<CellValue>> cells, std::size_t begin) {
  if (begin >= cells->size()) state_ = State::over;
  if (state_ == State::over) return;
  const std::size_t count = std::min(kCellsAtOnce, cells->size() - begin);
  onboard_.map.job(
      "take earlier map in", kMappingBudget,
      [cells, begin, count](Explorer& explorer) {
        return explorer.take_earlier(std::span(*cells).subspan(begin, count));
      },
      [this, cells, begin, count](const std::vector<CellChange>& changes) {
        onboard_.recorder.map_changes(onboard_.now(), changes);
        take_in(cells, begin + count);
      });
}

void EarlierMapSearch::hurry() {
  if (state_ == State::later && required()) give_up();
}

void EarlierMapSearch::give_up() {
  state_ = State::over;
  if (required()) refusal_ = "it cannot find its place in the earlier map: " + last_reason_;
  onboard_.recorder.write(onboard_.now(), event::EarlierMap{.state = event::EarlierMapState::given_up,
                                                            .reason = last_reason_,
                                                            .attempt = attempts_});
}

}  // namespace karst::core
