#include "sdk/host/hosted_policy.h"

#include <cstdio>

#include "core_stack/common/error.h"
#include "sdk/host/across.h"
#include "sdk/host/decision_box.h"
#include "sdk/host/decision_thread.h"
#include "sdk/host/parameters.h"
#include "sdk/host/plugin_file.h"
#include "sdk/host/process_state.h"
#include "sdk/host/selection.h"
#include "sdk/host/session.h"
#include "sdk/host/text.h"
#include "sdk/host/translation.h"

namespace karst::host {
namespace {

/// What one call into the plugin needs and leaves behind. Shared with the thread: it outlives a hang.
struct Call {
  std::shared_ptr<Session> session;
  karst_error_t error{};
  std::string failure;  // "" if the call succeeded
  std::string process_change;
};

class LoadedPolicy final : public HostedPolicy {
 public:
  LoadedPolicy(const PluginFile& plugin, const karst_policy_t& table, const PolicyChoice& choice)
      : table_(table),
        name_(cleaned(table.descriptor->id, kLineLimit)),
        version_(cleaned(table.descriptor->version, kLineLimit)),
        file_(plugin.path),
        choice_(choice),
        parameters_(*table.descriptor, choice.parameters, choice.source),
        session_(std::make_shared<Session>(choice.seed, name_)) {
    session_->set_decision_thread(thread_.id());
    if (!plugin.process_change.empty()) warn_of_change(plugin.process_change, "when it was opened");
    try {
      start();
    } catch (...) {
      end();
      throw;
    }
  }
  ~LoadedPolicy() override { end(); }

  std::string name() const override { return name_; }
  const std::string& version() const override { return version_; }
  const std::string& file() const override { return file_; }
  const boost::property_tree::ptree& parameters() const override { return parameters_.tree(); }
  bool abandoned() const override { return thread_.hangs(); }

  core::Decision decide(const core::DecisionRequest& request) override;
  void notify(const core::PolicyEvent& event) override;

 private:
  /// Runs `work(call)` on the decision thread, work returning a result code. "" or what went wrong.
  template <class Work>
  std::string call(const char* slot, Work work);
  void start();
  void end() noexcept;
  core::Decision failed(const std::string& why);
  void warn_of_change(const std::string& what, const std::string& when);
  void refuse(const core::DecisionRequest& request, const DecisionBox& box);

  const karst_policy_t& table_;
  std::string name_, version_, file_;
  PolicyChoice choice_;
  ResolvedParameters parameters_;
  std::shared_ptr<Session> session_;
  DecisionThread thread_;
  void* self_ = nullptr;
  bool active_ = false;
  int failures_ = 0;  // of decide, in a row
};

template <class Work>
std::string LoadedPolicy::call(const char* slot, Work work) {
  auto call = std::make_shared<Call>();
  call->session = session_;
  const ProcessState before;
  const bool returned = thread_.run(
      [call, work] {
        const ProcessState state;
        try {
          if (work(*call) != KARST_OK) call->failure = text_of(call->error);
        } catch (const std::exception& e) {
          call->failure = std::string("it threw an exception across the border: ") + e.what();
        } catch (...) {
          call->failure = "it threw an exception across the border";
        }
        call->process_change = state.restore();
      },
      choice_.hang_limit_s);
  if (!returned) {
    session_->abandon();
    before.restore();
    char text[120];
    std::snprintf(text, sizeof text, "%s() did not return within %g s: it is given up", slot,
                  choice_.hang_limit_s);
    return text;
  }
  if (!call->process_change.empty()) warn_of_change(call->process_change, std::string("in ") + slot + "()");
  return call->failure.empty() ? "" : std::string(slot) + "(): " + call->failure;
}

void LoadedPolicy::warn_of_change(const std::string& what, const std::string& when) {
  session_->note("warning: " + name_ + " changed " + what + " " + when + "; it was put back");
}

void LoadedPolicy::start() {
  const auto demand = [&](const std::string& fault) {
    if (!fault.empty()) throw core::InputError(file_, name_, fault);
  };
  // What the thread writes is shared: it may write it long after this function has given up.
  auto made = std::make_shared<void*>(nullptr);
  demand(call("create", [made, table = &table_](Call& c) -> std::int32_t {
    *made = across(table->create, c.session->host(), &c.error);
    return *made == nullptr ? KARST_ERROR_FAILED : KARST_OK;
  }));
  self_ = *made;
  // The texts of the values point into `parameters`.
  auto parameters =
      std::make_shared<ResolvedParameters>(*table_.descriptor, choice_.parameters, choice_.source);
  demand(call("init", [parameters, table = &table_, self = self_](Call& c) {
    const std::vector<karst_parameter_value_t> values = parameters->values();
    return across(table->init, self, values.data(), values.size(), &c.error);
  }));
  demand(call("activate",
              [table = &table_, self = self_](Call& c) { return across(table->activate, self, &c.error); }));
  active_ = true;
}

void LoadedPolicy::end() noexcept {
  if (self_ == nullptr || thread_.hangs()) return;
  const auto quit = [table = &table_, self = self_, active = active_](Call&) -> std::int32_t {
    if (active) across(table->deactivate, self);
    across(table->destroy, self);
    return KARST_OK;
  };
  call("destroy", quit);
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
  struct Question {
    Question(const core::DecisionRequest& r, const karst_map_t* map) : pack(r, map) {}
    RequestPack pack;
    DecisionBox box;
  };
  auto question = std::make_shared<Question>(request, session_->live_map());
  session_->begin_deciding(request);
  const std::string fault = call("decide", [question, table = &table_, self = self_](Call& c) {
    const karst_decision_sink_t sink = question->box.sink();
    return across(table->decide, self, &question->pack.request(), &sink, &c.error);
  });
  session_->end_deciding();
  if (thread_.hangs()) throw core::PolicyFailure(name_ + ": " + fault);
  if (!fault.empty()) return failed(fault);
  const DecisionBox& box = question->box;
  refuse(request, box);
  if (const std::string bad = box.fault(); !bad.empty()) return failed(bad);
  failures_ = 0;
  core::Decision decision = box.decision();
  decision.drawings = session_->take_drawings();
  decision.log = session_->take_log();
  return decision;
}

/// Tells the policy, and the log, which goals were malformed.
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
    return across(table->on_event, self, &out, &c.error);
  });
  if (!fault.empty()) session_->note("warning: " + name_ + ": " + fault);
}

}  // namespace

std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice, const SearchPath& path) {
  const Selection found = select_policy(choice.name, path);
  return std::make_unique<LoadedPolicy>(found.plugin, *found.policy, choice);
}

std::unique_ptr<HostedPolicy> load_policy(const PolicyChoice& choice) {
  return load_policy(choice, default_search_path(choice.plugin_files));
}

}  // namespace karst::host
