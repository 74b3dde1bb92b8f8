#include "sdk/python/binding/policy_table.h"

#include <pybind11/stl.h>

#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include "sdk/python/binding/services.h"

namespace karst::python {
namespace {

/// The functions of karst/_hosted.py, which know Python's side of a policy.
py::module_ hosted() { return py::module_::import("karst._hosted"); }

/// What is said of an exception of Python: a line for the error, and the traceback for the log.
struct Told {
  std::string line;
  std::vector<std::string> traceback;
};
Told told_of(const py::error_already_set& e) {
  try {
    if (e.trace()) PyException_SetTraceback(e.value().ptr(), e.trace().ptr());
    const auto [line, traceback] =
        hosted().attr("told_of")(e.value()).cast<std::pair<std::string, std::vector<std::string>>>();
    return {line, traceback};
  } catch (const std::exception& worse) {  // such as no memory left to format it
    return {std::string("an exception that cannot be shown: ") + worse.what(), {}};
  }
}

/// Runs `f` under Python's lock; an exception becomes an error, and its traceback goes into the host's log.
template <class F>
std::int32_t guarded(const karst_host_t* host, karst_error_t* error, F&& f) noexcept {
  try {
    const py::gil_scoped_acquire locked;
    try {
      f();
      return KARST_OK;
    } catch (const py::error_already_set& e) {
      const Told told = told_of(e);
      for (const std::string& line : told.traceback) host->log(host, KARST_LOG_WARNING, to_abi(line));
      border::fill(error, KARST_ERROR_EXCEPTION, told.line.c_str());
    } catch (const Error& e) {
      border::fill(error, e.code() == KARST_OK ? KARST_ERROR_FAILED : e.code(), e.what());
      return e.code() == KARST_OK ? KARST_ERROR_FAILED : e.code();
    } catch (const std::exception& e) {
      border::fill(error, KARST_ERROR_EXCEPTION, e.what());
    }
  } catch (...) {
    border::fill(error, KARST_ERROR_EXCEPTION, "Python could not be entered");
  }
  return KARST_ERROR_EXCEPTION;
}

/// A policy that the host has created.
struct Hosted {
  const karst_host_t* host = nullptr;
  py::object policy;
  std::shared_ptr<KeptMaps> maps = std::make_shared<KeptMaps>();
};
Hosted& self_of(void* self) { return *static_cast<Hosted*>(self); }

/// A class of policies: its table, descriptor, and the texts that they point to. Never freed: the host may
/// ask for it until the process ends.
struct Entry {
  py::object type;
  std::string id, name, version, one_line;
  std::vector<std::array<std::string, 5>> texts;  // of each parameter: id, unit, help, choices, default
  std::vector<karst_parameter_t> parameters;
  karst_policy_descriptor_t descriptor{};
  karst_policy_t policy{};
};

constexpr std::size_t kMostPolicies = 256, kMostPlugins = 256;

/// create() and policy() get no pointer by which they could know their class or plugin, so each has a
/// function of its own.
std::array<Entry*, kMostPolicies>& entries() {
  static std::array<Entry*, kMostPolicies> all{};
  return all;
}
struct Plugin {
  karst_plugin_t table{};
  std::vector<Entry*> policies;
};
std::array<Plugin*, kMostPlugins>& plugins() {
  static std::array<Plugin*, kMostPlugins> all{};
  return all;
}

void* create(const Entry& entry, const karst_host_t* host, karst_error_t* error) noexcept {
  Hosted* made = nullptr;
  guarded(host, error, [&] {
    std::array<double, 4> seed{};
    host->random(host, seed.data(), seed.size());
    auto h = std::make_unique<Hosted>();
    h->host = host;
    h->policy = hosted().attr("create")(entry.type, seed);
    made = h.release();
  });
  return made;
}
template <std::size_t I>
void* create_entry(const karst_host_t* host, karst_error_t* error) noexcept {
  return create(*entries()[I], host, error);
}
template <std::size_t I>
const karst_policy_t* policy_of_plugin(std::uint32_t index) noexcept {
  const Plugin& plugin = *plugins()[I];
  return index < plugin.policies.size() ? &plugin.policies[index]->policy : nullptr;
}

using Create = void* (*)(const karst_host_t*, karst_error_t*) noexcept;
using PolicyOf = const karst_policy_t* (*)(std::uint32_t) noexcept;
template <std::size_t... I>
std::array<Create, sizeof...(I)> all_creates(std::index_sequence<I...>) {
  return {&create_entry<I>...};
}
template <std::size_t... I>
std::array<PolicyOf, sizeof...(I)> all_policies(std::index_sequence<I...>) {
  return {&policy_of_plugin<I>...};
}

std::int32_t init(void* self, const karst_parameter_value_t* values, std::uint64_t count,
                  karst_error_t* error) noexcept {
  Hosted& h = self_of(self);
  return guarded(h.host, error, [&] {
    py::dict all;
    for (std::uint64_t i = 0; i < count; ++i) {
      const karst_parameter_value_t& v = values[i];
      const py::str id = from_abi(v.id);
      if (v.type == KARST_PARAMETER_TEXT)
        all[id] = from_abi(v.text);
      else if (v.type == KARST_PARAMETER_BOOLEAN)
        all[id] = v.number != 0;
      else if (v.type == KARST_PARAMETER_INTEGER)
        all[id] = static_cast<std::int64_t>(v.number);
      else
        all[id] = v.number;
    }
    hosted().attr("init")(h.policy, all);
  });
}

std::int32_t activate(void* self, karst_error_t* error) noexcept {
  Hosted& h = self_of(self);
  return guarded(h.host, error, [&] { h.policy.attr("activate")(); });
}

py::dict request_fields(const karst_request_t& r, const Request& view) {
  using namespace pybind11::literals;
  py::list sensors;
  for (const Sensor& s : view.sensors) sensors.append(sensor_fields(s));
  return py::dict(
      "sequence"_a = r.sequence, "stamp_ns"_a = r.stamp_ns, "deadline_ns"_a = r.deadline_ns,
      "position"_a = array_of(view.state.position), "velocity"_a = array_of(view.state.velocity),
      "orientation"_a = array_of(r.state.orientation), "body_rate"_a = array_of(view.state.body_rate),
      "direction_of_flight"_a = array_of(view.direction_of_flight),
      "start_position"_a = array_of(Vec3(r.T_world_start.position)),
      "start_orientation"_a = array_of(r.T_world_start.orientation),
      "seconds_before_homing"_a = r.seconds_before_homing, "max_speed_mps"_a = r.max_speed_mps,
      "clearance_m"_a = r.clearance_m, "vehicle_radius_m"_a = r.vehicle_radius_m,
      "last_goal"_a = array_of(view.last_goal), "last_fate"_a = r.last_fate,
      "frontiers"_a = records(r.frontiers, r.frontier_count),
      "teammates"_a = records(r.teammates, r.teammate_count), "sensors"_a = sensors,
      "battery_fraction"_a = view.battery_fraction, "battery_seconds_left"_a = view.battery_seconds_left,
      "mission_seconds_left"_a = view.mission_seconds_left);
}

std::int32_t decide(void* self, const karst_request_t* r, const karst_decision_sink_t* sink,
                    karst_error_t* error) noexcept {
  Hosted& h = self_of(self);
  return guarded(h.host, error, [&] {
    const Request view(h.host, *r);
    const auto term = std::make_shared<Term>();
    const struct Ending {
      Term& term;
      ~Ending() { term.end(); }
    } ending{*term};
    const py::object services = py::cast(Services(h.host, view, term, h.maps));
    const py::tuple answer = hosted().attr("decide")(h.policy, services, request_fields(*r, view));
    Decision decision;
    decision.outcome = answer[0].cast<karst_outcome_t>();
    decision.in_order = answer[1].cast<bool>();
    decision.reason = answer[2].cast<std::string>();
    for (const py::handle& goal : answer[3]) decision.goals.push_back(goal_of(goal));
    border::fit(decision, sink->max_goals, view);
    std::vector<karst_goal_t> goals;
    for (const Goal& g : decision.goals) goals.push_back(to_abi(g));
    karst_error_t e{};
    if (!goals.empty()) check(sink->add_goals(sink, goals.data(), goals.size(), &e), e);
    const std::uint32_t flags = decision.in_order ? std::uint32_t{KARST_DECISION_TOUR} : 0u;
    check(sink->set_outcome(sink, decision.outcome, flags, to_abi(decision.reason), &e), e);
  });
}

std::int32_t on_event(void* self, const karst_event_t* event, karst_error_t* error) noexcept {
  Hosted& h = self_of(self);
  return guarded(h.host, error, [&] {
    const Goal goal = from_abi(event->goal);
    hosted().attr("on_event")(h.policy, event->kind, event->stamp_ns,
                              py::make_tuple(array_of(goal.position), goal.heading_rad, goal.tolerance_m,
                                             goal.max_speed_mps, goal.frontier_id, goal.score, goal.why),
                              from_abi(event->reason));
  });
}

void deactivate(void* self) noexcept {
  Hosted& h = self_of(self);
  karst_error_t ignored{};
  guarded(h.host, &ignored, [&] { h.policy.attr("deactivate")(); });
}

void destroy(void* self) noexcept {
  karst_error_t ignored{};
  guarded(self_of(self).host, &ignored, [&] {
    self_of(self).maps->end();
    delete &self_of(self);
  });
}

std::int32_t save(void* self, const karst_state_sink_t* sink, karst_error_t* error) noexcept {
  Hosted& h = self_of(self);
  return guarded(h.host, error, [&] {
    const std::string bytes = hosted().attr("save")(h.policy).cast<std::string>();
    karst_error_t e{};
    check(sink->write(sink, bytes.data(), bytes.size(), &e), e);
  });
}

std::int32_t restore(void* self, const void* bytes, std::uint64_t count, karst_error_t* error) noexcept {
  Hosted& h = self_of(self);
  return guarded(h.host, error, [&] {
    hosted().attr("restore")(h.policy, py::bytes(static_cast<const char*>(bytes), count));
  });
}

/// karst.state/1 for a policy that has something to save.
const void* extension(void* self, karst_text_t id) noexcept {
  if (from_abi(id) != KARST_STATE_EXTENSION) return nullptr;
  static constexpr karst_state_extension_t table{sizeof table, 0, &save, &restore};
  Hosted& h = self_of(self);
  bool remembers = false;
  karst_error_t ignored{};
  guarded(h.host, &ignored, [&] { remembers = hosted().attr("remembers")(h.policy).cast<bool>(); });
  return remembers ? &table : nullptr;
}

/// What the class declares (karst/_hosted.py, `description_of`), as the ABI has it.
void describe(Entry& e) {
  const py::dict d = hosted().attr("description_of")(e.type);
  e.id = d["id"].cast<std::string>();
  e.name = d["name"].cast<std::string>();
  e.version = d["version"].cast<std::string>();
  e.one_line = d["one_line"].cast<std::string>();
  const py::list parameters = d["parameters"];
  e.texts.reserve(parameters.size());
  for (const py::handle& item : parameters) {
    const py::dict p = py::reinterpret_borrow<py::dict>(item);
    const auto text = [&](const char* key) { return p[key].cast<std::string>(); };
    e.texts.push_back({text("id"), text("unit"), text("help"), text("choices"), text("default_text")});
    const auto& t = e.texts.back();
    e.parameters.push_back({to_abi(t[0]), to_abi(t[1]), to_abi(t[2]), to_abi(t[3]), to_abi(t[4]),
                            p["default_number"].cast<double>(), p["low"].cast<double>(),
                            p["high"].cast<double>(), p["type"].cast<karst_parameter_type_t>(), 0});
  }
}

Entry* make_entry(const py::object& type, Create create) {
  auto e = std::make_unique<Entry>();
  e->type = type;
  describe(*e);
  e->descriptor.size = sizeof e->descriptor;
  e->descriptor.id = to_abi(e->id);
  e->descriptor.name = to_abi(e->name);
  e->descriptor.version = to_abi(e->version);
  e->descriptor.min_host[1] = 1;
  e->descriptor.parameter_count = static_cast<std::uint32_t>(e->parameters.size());
  e->descriptor.parameters = e->parameters.data();
  e->descriptor.one_line = to_abi(e->one_line);
  e->policy = {sizeof e->policy, 0,         &e->descriptor, create,   &init,     &activate,
               &decide,          &on_event, &deactivate,    &destroy, &extension};
  return e.release();
}

/// The entry of a class, made at the first call.
Entry* entry_of(const py::object& type) {
  static const std::array<Create, kMostPolicies> creates =
      all_creates(std::make_index_sequence<kMostPolicies>{});
  auto& all = entries();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] != nullptr && all[i]->type.is(type)) return all[i];
    if (all[i] == nullptr) return all[i] = make_entry(type, creates[i]);
  }
  throw Error("this process has opened " + std::to_string(kMostPolicies) +
              " policies of Python, and has no room for more");
}

}  // namespace

Goal goal_of(const py::handle& o) {
  Goal g;
  g.position = point_of(o.attr("position").cast<Doubles>(), "the position of a goal");
  g.heading_rad = o.attr("heading_rad").cast<double>();
  g.tolerance_m = o.attr("tolerance_m").cast<double>();
  g.max_speed_mps = o.attr("max_speed_mps").cast<double>();
  g.frontier_id = o.attr("frontier_id").cast<std::uint32_t>();
  g.score = o.attr("score").cast<double>();
  g.why = o.attr("why").cast<std::string>();
  return g;
}

const karst_plugin_t* plugin_of(const std::vector<py::object>& classes) {
  static const std::array<PolicyOf, kMostPlugins> policies =
      all_policies(std::make_index_sequence<kMostPlugins>{});
  std::vector<Entry*> wanted;
  for (const py::object& type : classes) wanted.push_back(entry_of(type));
  auto& all = plugins();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] != nullptr && all[i]->policies == wanted) return &all[i]->table;
    if (all[i] != nullptr) continue;
    all[i] = new Plugin{{sizeof(karst_plugin_t), KARST_ABI_MAJOR, KARST_ABI_MINOR,
                         static_cast<std::uint32_t>(wanted.size()), policies[i]},
                        wanted};
    return &all[i]->table;
  }
  throw Error("this process has opened " + std::to_string(kMostPlugins) +
              " files of Python policies, and has no room for more");
}

}  // namespace karst::python
