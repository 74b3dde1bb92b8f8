// What the host of a policy offers, for Python: the map of one request or a copy of it, paths, gains,
// drawings.
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include <karst/imaged.h>
#include <karst/policy.h>
#include <karst/survey.h>

#include "sdk/python/binding/arrays.h"

namespace karst::python {

/// For how long the host answers: while decide() runs, for example. Later questions would read freed memory.
class Term {
 public:
  /// Waits for what other threads of the policy are asking. `why` is what later questions are told.
  void end(const char* why = "this request has ended: keep what it said, or request.map.retained()") {
    const py::gil_scoped_release they_may_end;
    const std::unique_lock none_asks(asking_);
    ended_ = why;
  }
  /// It does not end while this is held. Not to be taken under Python's lock: end() may wait.
  std::shared_lock<std::shared_mutex> held() const {
    std::shared_lock lock(asking_);
    require();
    return lock;
  }
  void require() const {
    if (const char* why = ended_) throw Error(why, KARST_ERROR_STATE);
  }

 private:
  mutable std::shared_mutex asking_;
  std::atomic<const char*> ended_ = nullptr;
};

/// The copies of maps that a policy keeps. The host takes them back when the policy ends: Python may hold its
/// objects for longer.
class KeptMaps {
 public:
  void add(const std::shared_ptr<MapView>& view, const std::shared_ptr<Term>& term) {
    const std::lock_guard lock(adding_);
    all_.push_back({view, term});
  }
  void end() {
    for (const auto& [view, term] : all_) {
      term->end("the policy that kept this map has ended");
      if (const std::shared_ptr<MapView> left = view.lock()) *left = MapView();
    }
    all_.clear();
  }

 private:
  std::mutex adding_;
  std::vector<std::pair<std::weak_ptr<MapView>, std::shared_ptr<Term>>> all_;
};

/// The occupancy map. All calls release Python's lock while the host answers.
class Map {
 public:
  Map(MapView view, std::shared_ptr<Term> term, std::shared_ptr<KeptMaps> kept)
      : view_(std::make_shared<MapView>(std::move(view))), term_(std::move(term)), kept_(std::move(kept)) {}

  py::dict info() const;
  py::array cells(const Doubles& points) const;
  py::array cast_rays(const Doubles& from, const Doubles& to, bool through_unknown) const;
  py::array counts(const Doubles& low, const Doubles& high) const;
  py::array surface(const Doubles& low, const Doubles& high) const;
  py::array distances_to_rock(const Doubles& points, double limit_m) const;
  py::tuple passages() const;
  py::array passages_at(const Doubles& points) const;
  Map retained() const;

 private:
  const MapView& view() const {
    term_->require();
    return *view_;
  }

  std::shared_ptr<MapView> view_;
  std::shared_ptr<Term> term_;  // of the request; of a copy, of the policy
  std::shared_ptr<KeptMaps> kept_;
};

/// The services of one request.
class Services {
 public:
  Services(const karst_host_t* host, const Request& request, std::shared_ptr<Term> term,
           std::shared_ptr<KeptMaps> kept)
      : host_(host), request_(request), term_(std::move(term)), kept_(std::move(kept)) {}

  Map map() const { return {request().map, term_, kept_}; }
  py::array path_lengths(const Doubles& from, const Doubles& goals, double tolerance_m) const;
  py::list paths(const Doubles& from, const Doubles& goals, double tolerance_m) const;
  py::array newly_seen(std::size_t sensor, const Doubles& viewpoints,
                       std::optional<double> max_range_m) const;
  void draw_points(const Doubles& points, std::uint32_t rgb) const;
  void draw_lines(const Doubles& from, const Doubles& to, std::uint32_t rgb) const;
  void draw_text(const Doubles& at, const std::string& text, std::uint32_t rgb) const;
  void log(const std::string& text, std::uint32_t level) const;
  py::array_t<double> random(std::size_t count) const;
  bool should_stop() const { return request().should_stop(); }

  /// None if the mission has no survey: its legs, its leads.
  py::object survey() const;
  py::array survey_distances(const Doubles& points) const;
  /// None if the vehicle carries no colour camera.
  py::object imaging_camera() const;
  py::array imaged_states(const Doubles& points) const;
  py::array unimaged(const Doubles& low, const Doubles& high) const;
  py::array newly_imaged(const Doubles& viewpoints) const;

 private:
  const Request& request() const {
    term_->require();
    return request_;
  }
  const karst_host_t* host() const {
    term_->require();
    return host_;
  }
  SurveyView known_survey() const;
  ImagedView imaged() const;

  const karst_host_t* host_;
  const Request& request_;
  std::shared_ptr<Term> term_;
  std::shared_ptr<KeptMaps> kept_;
};

/// Name, kind and field of view.
py::dict sensor_fields(const Sensor& sensor);

void bind_services(py::module_& module);

}  // namespace karst::python
