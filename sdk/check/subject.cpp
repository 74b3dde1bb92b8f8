#include "sdk/check/subject.h"

#include <time.h>

#include <chrono>
#include <cstdio>

#include "sdk/host/boundary/call_plugin.h"
#include "sdk/host/boundary/policy_state.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/plugin/process_state.h"
#include "sdk/host/services/translation.h"

namespace karst::check {
namespace {

using host::call_plugin;

double cpu_now_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string exact(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", v);
  return text;
}

}  // namespace

std::string Answer::text() const {
  if (!good()) return "fault: " + fault();
  const core::Decision d = box.decision();
  std::string out = "outcome " + std::to_string(static_cast<int>(d.outcome)) +
                    (box.is_tour() ? " tour" : "") + ": " + d.reason + "\n";
  for (const core::Goal& g : d.goals) {
    for (const double v : {g.position.x(), g.position.y(), g.position.z(), g.heading_rad, g.tolerance_m,
                           g.max_speed_mps, g.score})
      out += exact(v) + " ";
    out += std::to_string(g.frontier_id) + " " + g.why + "\n";
  }
  for (const auto& [goal, why] : box.refused()) out += "refused " + why + "\n";
  return out;
}

Object::Object(Context& context, host::Session& session, const karst_host_t* host)
    : context_(context), session_(session), host_(host == nullptr ? session.host() : host) {
  create_fault_ = call("create()", [&](karst_error_t& e) -> std::int32_t {
    self_ = call_plugin(context_.policy->create, host_, &e);
    return self_ == nullptr ? KARST_ERROR_FAILED : KARST_OK;
  });
}

Object::~Object() { destroy(); }

template <class Work>
std::string Object::call(const std::string& slot, Work work) {
  karst_error_t error{};
  std::string fault;
  const host::ProcessState before;
  context_.progress->enter(slot);
  try {
    if (work(error) != KARST_OK) fault = slot + ": " + host::text_of(error);
  } catch (const std::exception& e) {
    fault = slot + ": it threw an exception across the border: " + e.what();
  } catch (...) {
    fault = slot + ": it threw an exception across the border";
  }
  context_.progress->leave();
  if (const std::string changed = before.restore(); !changed.empty())
    changes_.push_back(slot + " changed " + changed);
  return fault;
}

std::string Object::init(const std::vector<karst_parameter_value_t>& values) {
  return call("init()", [&](karst_error_t& e) {
    return call_plugin(context_.policy->init, self_, values.data(), values.size(), &e);
  });
}
std::string Object::activate() {
  return call("activate()",
              [&](karst_error_t& e) { return call_plugin(context_.policy->activate, self_, &e); });
}
std::string Object::deactivate() {
  return call("deactivate()", [&](karst_error_t&) -> std::int32_t {
    call_plugin(context_.policy->deactivate, self_);
    return KARST_OK;
  });
}
std::string Object::destroy() {
  if (self_ == nullptr) return "";
  return call("destroy()", [&](karst_error_t&) -> std::int32_t {
    call_plugin(context_.policy->destroy, std::exchange(self_, nullptr));
    return KARST_OK;
  });
}
std::string Object::event(const karst_event_t& event) {
  session_.set_now(event.stamp_ns);
  return call("on_event(), kind " + std::to_string(event.kind),
              [&](karst_error_t& e) { return call_plugin(context_.policy->on_event, self_, &event, &e); });
}

const karst_state_extension_t* Object::state() {
  const karst_state_extension_t* table = nullptr;
  require(call("extension()", [&](karst_error_t&) -> std::int32_t {
    table = host::state_extension(*context_.policy, self_);
    return KARST_OK;
  }));
  return table;
}
std::string Object::save(std::vector<std::byte>& bytes) {
  const karst_state_extension_t* table = state();
  std::string fault;
  const std::string thrown = call("save()", [&](karst_error_t&) -> std::int32_t {
    fault = host::save_state(*table, self_, bytes);
    return KARST_OK;
  });
  return !thrown.empty() ? thrown : fault.empty() ? "" : "save(): " + fault;
}
std::string Object::restore(const std::vector<std::byte>& bytes) {
  const karst_state_extension_t* table = state();
  std::string fault;
  const std::string thrown = call("restore()", [&](karst_error_t&) -> std::int32_t {
    fault = host::restore_state(*table, self_, bytes);
    return KARST_OK;
  });
  return !thrown.empty() ? thrown : fault.empty() ? "" : "restore(): " + fault;
}

Answer Object::decide(const core::DecisionRequest& request) {
  Answer answer;
  const host::RequestPack pack(request, session_.live_map());
  const karst_decision_sink_t sink = answer.box.sink();
  session_.begin_deciding(request);
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin_s = cpu_now_s();
  answer.failure = call("decide(), request " + std::to_string(request.sequence), [&](karst_error_t& e) {
    return call_plugin(context_.policy->decide, self_, &pack.request(), &sink, &e);
  });
  answer.cpu_s = cpu_now_s() - cpu_begin_s;
  answer.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  session_.end_deciding();
  session_.take_drawings();
  session_.take_log();
  // An error caused by the sink's refusal is a fault of the answer, which other tests check.
  if (answer.box.misused() && answer.failure.find("exception") == std::string::npos) answer.failure.clear();
  return answer;
}

std::vector<karst_parameter_value_t> defaults(const karst_policy_t& policy) {
  std::vector<karst_parameter_value_t> out;
  const karst_policy_descriptor_t& d = *policy.descriptor;
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    const karst_parameter_t& p = d.parameters[i];
    const bool text = p.type == KARST_PARAMETER_TEXT;
    out.push_back(
        {p.id, text ? p.default_text : karst_text_t{nullptr, 0}, text ? 0.0 : p.default_number, p.type, 0});
  }
  return out;
}

std::unique_ptr<Object> started(Context& context, host::Session& session, const karst_host_t* host) {
  auto object = std::make_unique<Object>(context, session, host);
  require(object->create_fault());
  require(object->init(defaults(*context.policy)));
  require(object->activate());
  return object;
}

std::unique_ptr<host::Session> new_session(const Context& context) {
  auto session = std::make_unique<host::Session>(context.seed, context.id);
  session->set_decision_thread(std::this_thread::get_id());
  return session;
}

void require(const std::string& fault, const std::string& where) {
  if (!fault.empty()) throw Failed{where.empty() ? fault : where + ": " + fault};
}

}  // namespace karst::check
