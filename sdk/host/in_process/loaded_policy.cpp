#include "sdk/host/in_process/loaded_policy.h"

#include <cstdio>

#include "core_stack/common/error.h"
#include "sdk/host/boundary/asked.h"
#include "sdk/host/boundary/call_plugin.h"
#include "sdk/host/boundary/policy_state.h"
#include "sdk/host/boundary/text.h"
#include "sdk/host/in_process/crash_note.h"
#include "sdk/host/plugin/process_state.h"
#include "sdk/host/services/translation.h"

namespace karst::host {

/// Inputs and results of one call into the plugin. Shared with the thread, so that it outlives a hang.
struct LoadedPolicy::Call {
  std::shared_ptr<Session> session;
  karst_error_t error{};
  std::string failure;  // "" if the call succeeded
  std::string process_change;
  std::string if_it_crashes;  // said on stderr
};

LoadedPolicy::LoadedPolicy(const PluginFile& plugin, const karst_policy_t& table, const PolicyChoice& choice,
                           const PolicyLegacy& former, PathLengths lengths, PathSearch paths)
    : table_(table),
      name_(cleaned(table.descriptor->id, kLineLimit)),
      version_(cleaned(table.descriptor->version, kLineLimit)),
      file_(plugin.path),
      choice_(choice),
      parameters_(*table.descriptor, choice.parameters, choice.source),
      lengths_(std::move(lengths)),
      paths_(std::move(paths)),
      session_(std::make_shared<Session>(choice.seed, name_, former.numbers_drawn)) {
  session_->set_decision_thread(thread_.id());
  if (!plugin.process_change.empty()) warn_of_change(plugin.process_change, "when it was opened");
  try {
    start(former);
  } catch (...) {
    end();
    throw;
  }
}

template <class Work>
std::string LoadedPolicy::call(const char* slot, Work work) {
  auto call = std::make_shared<Call>();
  call->session = session_;
  call->if_it_crashes = if_it_crashes(slot);
  const ProcessState before;
  const std::string given_up_as = thread_.run(
      [call, work] {
        const ProcessState state;
        try {
          CrashNote note(call->if_it_crashes);
          if (work(*call) != KARST_OK) call->failure = text_of(call->error);
        } catch (const std::exception& e) {
          call->failure = std::string("it threw an exception across the border: ") + e.what();
        } catch (...) {
          call->failure = "it threw an exception across the border";
        }
        call->process_change = state.restore();
      },
      {choice_.hang_limit_s, choice_.cpu_limit_s});
  if (!given_up_as.empty()) {
    session_->abandon();
    before.restore();
    return std::string(slot) + "() " + given_up_as + ": it is given up";
  }
  if (!call->process_change.empty()) warn_of_change(call->process_change, std::string("in ") + slot + "()");
  return call->failure.empty() ? "" : std::string(slot) + "(): " + call->failure;
}

/// Nothing for a policy's own process: its host says how that ended.
std::string LoadedPolicy::if_it_crashes(const std::string& slot) const {
  if (choice_.isolation == Isolation::process) return "";
  const std::string request = last_request_ == 0 ? "before the first request"
                              : slot == "decide" ? "request " + std::to_string(last_request_)
                                                 : "after request " + std::to_string(last_request_);
  return "karst: the policy " + name_ + " crashed in " + slot + "(), " + request;
}

void LoadedPolicy::warn_of_change(const std::string& what, const std::string& when) {
  session_->note("warning: " + name_ + " changed " + what + " " + when + "; it was put back");
}

void LoadedPolicy::require(const std::string& fault) const {
  if (!fault.empty()) throw core::InputError(file_, name_, fault);
}

void LoadedPolicy::start(const PolicyLegacy& former) {
  create_and_init();
  if (const std::string fault = restore(former); !fault.empty()) {
    session_->note("warning: " + name_ + " begins anew: " + fault);
    end();
    create_and_init();
  }
  require(call("activate", [table = &table_, self = self_](Call& c) {
    return call_plugin(table->activate, self, &c.error);
  }));
  active_ = true;
}

void LoadedPolicy::create_and_init() {
  // The result is shared: the thread may write it long after this function has stopped waiting.
  auto made = std::make_shared<void*>(nullptr);
  require(call("create", [made, table = &table_](Call& c) -> std::int32_t {
    *made = call_plugin(table->create, c.session->host(), &c.error);
    return *made == nullptr ? KARST_ERROR_FAILED : KARST_OK;
  }));
  self_ = *made;
  // The texts of the values point into `parameters`.
  auto parameters =
      std::make_shared<ResolvedParameters>(*table_.descriptor, choice_.parameters, choice_.source);
  require(call("init", [parameters, table = &table_, self = self_](Call& c) {
    const std::vector<karst_parameter_value_t> values = parameters->values();
    return call_plugin(table->init, self, values.data(), values.size(), &c.error);
  }));
}

std::string LoadedPolicy::restore(const PolicyLegacy& former) {
  if (!former.state) return "";
  return call("restore", [state = *former.state, table = &table_, self = self_](Call& c) -> std::int32_t {
    const karst_state_extension_t* extension = state_extension(*table, self);
    const std::string fault = extension == nullptr ? "" : restore_state(*extension, self, state);
    if (!fault.empty()) fill_error(&c.error, KARST_ERROR_FAILED, fault);
    return fault.empty() ? KARST_OK : KARST_ERROR_FAILED;
  });
}

PolicyLegacy LoadedPolicy::legacy() {
  PolicyLegacy out;
  out.numbers_drawn = session_->numbers_drawn();
  if (thread_.hangs()) return out;
  auto state = std::make_shared<std::optional<Bytes>>();
  const std::string fault = call("save", [state, table = &table_, self = self_](Call& c) -> std::int32_t {
    const karst_state_extension_t* extension = state_extension(*table, self);
    if (extension == nullptr) return KARST_OK;
    state->emplace();
    const std::string why = save_state(*extension, self, **state);
    if (!why.empty()) fill_error(&c.error, KARST_ERROR_FAILED, why);
    return why.empty() ? KARST_OK : KARST_ERROR_FAILED;
  });
  if (fault.empty()) out.state = std::move(*state);
  return out;
}

void LoadedPolicy::end() noexcept {
  if (self_ == nullptr || thread_.hangs()) return;
  const auto quit = [table = &table_, self = self_, active = active_](Call&) -> std::int32_t {
    if (active) call_plugin(table->deactivate, self);
    call_plugin(table->destroy, self);
    return KARST_OK;
  };
  call("destroy", quit);
  self_ = nullptr;
  active_ = false;
}

core::Decision LoadedPolicy::failed(const std::string& why) {
  ++failures_;
  if (failures_ > choice_.failures_allowed)
    throw core::PolicyFailure(name_ + " failed " + std::to_string(failures_) +
                              " times in a row, the last time: " + why);
  core::Decision d;
  d.outcome = core::Outcome::hold;
  d.reason = name_ + " failed: " + why;
  d.drawings = session_->take_drawings();
  d.log = session_->take_log();
  d.log.push_back("warning: " + d.reason);
  return d;
}

core::Decision LoadedPolicy::decide(const core::DecisionRequest& request) {
  if (thread_.hangs()) throw core::PolicyFailure(name_ + " hangs");
  last_request_ = request.sequence;
  struct Question {
    Question(const core::DecisionRequest& r, const karst_map_t* map) : pack(r, map) {}
    RequestPack pack;
    DecisionBox box;
  };
  auto question = std::make_shared<Question>(request, session_->live_map());
  session_->begin_deciding(request, lengths_, paths_);
  const std::string fault = call("decide", [question, table = &table_, self = self_](Call& c) {
    const karst_decision_sink_t sink = question->box.sink();
    return call_plugin(table->decide, self, &question->pack.request(), &sink, &c.error);
  });
  session_->end_deciding();
  const std::string where = ", " + asked(request);
  if (thread_.hangs()) throw core::PolicyFailure(name_ + ": " + fault + where);
  if (!fault.empty()) return failed(fault + where);
  const DecisionBox& box = question->box;
  refuse(request, box);
  if (const std::string bad = box.fault(); !bad.empty()) return failed(bad + where);
  failures_ = 0;
  core::Decision decision = box.decision();
  decision.drawings = session_->take_drawings();
  decision.log = session_->take_log();
  return decision;
}

/// Reports malformed goals to the policy and to the log.
void LoadedPolicy::refuse(const core::DecisionRequest& request, const DecisionBox& box) {
  for (const auto& [goal, why] : box.refused()) {
    session_->note("warning: " + name_ + ": " + why);
    notify({core::PolicyEvent::Kind::goal_rejected, request.stamp, goal, why});
  }
}

void LoadedPolicy::notify(const core::PolicyEvent& event) {
  if (thread_.hangs()) return;
  session_->set_now(event.stamp);
  auto copy = std::make_shared<core::PolicyEvent>(event);
  const std::string fault = call("on_event", [copy, table = &table_, self = self_](Call& c) {
    const karst_event_t out = to_abi(*copy);
    return call_plugin(table->on_event, self, &out, &c.error);
  });
  if (!fault.empty()) session_->note("warning: " + name_ + ": " + fault);
}

}  // namespace karst::host
