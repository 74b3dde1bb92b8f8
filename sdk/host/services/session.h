// The host's side of one policy object: the service tables, and the data that they may access at present.
//
// An abandoned policy may still be inside a service, reading the core's map. `abandon` therefore first
// tells the running services to stop, then waits for them to return; from then on every service fails.
// Threads that may still call a service hold the session by shared_ptr.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <thread>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/mission/policy/policy_port.h"
#include "core_stack/planning/trajectory/trajectory.h"
#include "sdk/abi/karst_abi_imaged.h"
#include "sdk/abi/karst_abi_survey.h"
#include "sdk/host/services/path_question.h"
#include "sdk/host/services/snapshot.h"

namespace karst::host {

class Session {
 public:
  /// `numbers_drawn`: random numbers that a former session of this policy has drawn from its stream.
  Session(std::uint64_t seed, const std::string& policy_id, std::uint64_t numbers_drawn = 0);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const karst_host_t* host() const { return &host_; }
  /// The thread whose slots are tagged [decision thread].
  void set_decision_thread(std::thread::id id) { decision_thread_ = id; }
  void set_now(core::TimeNs now) { now_ = now; }

  /// Between these two calls the policy may query map and paths; `lengths` and `paths`, if given, replace the
  /// roadmap.
  void begin_deciding(const core::DecisionRequest& request, const PathLengths& lengths = {},
                      const PathSearch& paths = {});
  void end_deciding();
  void abandon();

  /// The request's snapshot, as the policy sees it.
  const karst_map_t* live_map() const { return reinterpret_cast<const karst_map_t*>(&live_); }
  std::vector<core::Drawing> take_drawings();
  std::vector<std::string> take_log();
  void note(std::string line);
  std::uint64_t numbers_drawn() const { return numbers_drawn_; }

 private:
  friend struct Serving;
  friend struct Services;
  friend struct ImagedServices;
  friend struct SurveyServices;
  const Snapshot* find(const karst_map_t* map);

  karst_map_service_t map_service_{};
  karst_path_service_t path_service_{};
  karst_gain_service_t gain_service_{};
  karst_draw_service_t draw_service_{};
  karst_host_t host_{};

  std::shared_mutex gate_;  // shared: inside a service; exclusive: changing the data services access
  std::atomic<bool> abandoned_ = false;
  std::atomic<core::TimeNs> now_ = 0;
  std::thread::id decision_thread_;
  Snapshot live_;
  PathLengths lengths_;
  PathSearch paths_;
  core::MotionLimits motion_;                    // of the request, for travel times
  const core::ImagedSurface* imaged_ = nullptr;  // null: no colour camera
  const core::RgbCameraModel* rgb_ = nullptr;
  std::optional<core::UnimagedSurface> unimaged_;   // of this request; computed on first use
  const core::SurveyedPassages* survey_ = nullptr;  // null: the mission has no survey
  std::mutex kept_mutex_;
  std::map<const karst_map_t*, std::unique_ptr<Snapshot>> kept_;

  std::mutex output_mutex_;
  std::vector<core::Drawing> drawings_;
  std::size_t drawn_points_ = 0;
  std::vector<std::string> log_;
  core::Random random_;
  std::uint64_t numbers_drawn_ = 0;
};

/// The extension "karst.imaged/1".
const karst_imaged_service_t* imaged_service();

/// The extension "karst.survey/1".
const karst_survey_service_t* survey_service();

/// Fills the four service tables and the host table with the functions of services.cpp.
void install_services(Session& session, karst_host_t& host);

}  // namespace karst::host
