#include "sdk/host/isolation/isolated_policy.h"

#include <utility>

#include "core_stack/common/error.h"
#include "sdk/host/boundary/asked.h"
#include "sdk/host/serialization/flat_request.h"

namespace karst::host {
namespace {

/// The answer to a query of the child, whose arguments are not trusted.
PathAnswer lengths(const core::DecisionRequest* request, const Bytes& body) {
  const LengthsQuestion q = read_lengths_question(body);
  if (request == nullptr || request->map == nullptr || request->roadmap == nullptr) return {};
  return path_lengths(*request->map, *request->roadmap, q.from, q.goals, q.tolerance_m);
}

PathsAnswer paths(const core::DecisionRequest* request, const Bytes& body) {
  const LengthsQuestion q = read_lengths_question(body);
  if (request == nullptr || request->map == nullptr || request->roadmap == nullptr) return {};
  return find_paths(*request->map, *request->roadmap, q.from, q.goals, q.tolerance_m);
}

/// "file: place: reason", as thrown in the policy's process.
core::InputError input_error(const std::string& text) {
  const std::size_t colon = text.find(": ");
  return colon == std::string::npos ? core::InputError("policy", "", text)
                                    : core::InputError(text.substr(0, colon), "", text.substr(colon + 2));
}

}  // namespace

IsolatedPolicy::IsolatedPolicy(const std::string& file, const PolicyChoice& choice)
    : file_(file), choice_(choice) {
  try {
    start();
  } catch (const ProcessBroken& e) {
    throw core::InputError(file_, choice_.name, e.what());
  }
}

IsolatedPolicy::~IsolatedPolicy() {
  if (!process_) return;
  try {
    process_->begin_call("destroy");
    process_->send(static_cast<std::uint32_t>(Said::end), {});
    process_->expect_end();
  } catch (const std::exception&) {  // the process is ended in any case
  }
}

void IsolatedPolicy::start_confined(CallLimits limits) {
  StartOrder order;
  order.file = file_;
  order.policy = choice_.name;
  order.source = choice_.source;
  order.parameters = choice_.parameters;
  order.seed = choice_.seed;
  order.failures_allowed = choice_.failures_allowed;
  order.memory_limit_bytes = static_cast<std::uint64_t>(choice_.memory_limit_mib) << 20;
  order.legacy = legacy_;
  process_.reset();
  map_sent_ = nullptr;
  revision_sent_ = 0;
  std::string why;
  try {
    process_ = std::make_unique<PolicyProcess>(policy_child_program(), limits, choice_.output);
    process_->begin_call("start");
    process_->send(static_cast<std::uint32_t>(Said::start), flatten(order));
    const RingMessage said = process_->receive(kMaxAnswerBytes);
    process_->end_call();
    if (said.kind == static_cast<std::uint32_t>(Said::confined)) return;
    const bool tells = said.kind == static_cast<std::uint32_t>(Said::unconfined);
    why = tells ? read_text(said.body) : "it answered something else in start()";
  } catch (const std::exception& e) {  // such as no memory to share, no program to run, an end in it
    why = e.what();
  }
  process_.reset();
  throw CannotConfine(why);
}

void IsolatedPolicy::start() {
  const CallLimits limits{choice_.hang_limit_s, choice_.cpu_limit_s};
  start_confined({restarted_ ? limits.wall_s : choice_.start_hang_limit_s, limits.cpu_s});
  try {
    process_->begin_cycle();
    process_->begin_call("create");
    const RingMessage said = answer(nullptr);
    if (said.kind == static_cast<std::uint32_t>(Said::refused)) throw input_error(read_text(said.body));
    if (said.kind != static_cast<std::uint32_t>(Said::ready))
      throw ProcessBroken("it did not say it is ready");
    ready_ = read_ready_report(said.body);
  } catch (const FlatError& e) {
    throw ProcessBroken(std::string("garbage came from its process in create(): ") + e.what());
  }
  process_->set_limits(limits);
}

RingMessage IsolatedPolicy::question(const char* call, Said kind, const Bytes& body,
                                     const core::DecisionRequest* request) {
  if (!process_) throw ProcessBroken("it has no process any more");
  if (kind != Said::event) process_->begin_cycle();
  process_->begin_call(call);
  process_->send(static_cast<std::uint32_t>(kind), body);
  return answer(request);
}

RingMessage IsolatedPolicy::answer(const core::DecisionRequest* request) {
  for (;;) {
    RingMessage said = process_->receive(kMaxAnswerBytes);
    const bool asks_lengths = said.kind == static_cast<std::uint32_t>(Said::asks_lengths);
    if (!asks_lengths && said.kind != static_cast<std::uint32_t>(Said::asks_paths)) {
      process_->end_call();
      return said;
    }
    process_->check();  // repeated queries must not escape the limits
    if (asks_lengths) {
      process_->send(static_cast<std::uint32_t>(Said::lengths), flatten(lengths(request, said.body)));
    } else {
      process_->send(static_cast<std::uint32_t>(Said::paths), flatten(paths(request, said.body)));
    }
  }
}

core::Decision IsolatedPolicy::ask(const core::DecisionRequest& request) {
  const core::VoxelMap* map = request.map;
  const bool known = map != nullptr && map == map_sent_ && map->revision() >= revision_sent_;
  const Bytes body = flatten(request, known ? revision_sent_ : 0);
  map_sent_ = map;
  revision_sent_ = map == nullptr ? 0 : map->revision();
  const RingMessage said = question("decide", Said::decide, body, &request);
  if (said.kind == static_cast<std::uint32_t>(Said::gave_up)) throw core::PolicyFailure(read_text(said.body));
  if (said.kind != static_cast<std::uint32_t>(Said::decided))
    throw ProcessBroken("it answered something else in decide()");
  DecisionReport report = read_decision_report(said.body);
  legacy_.numbers_drawn = report.legacy.numbers_drawn;
  if (report.legacy.state) legacy_.state = std::move(report.legacy.state);
  return std::move(report.decision);
}

core::Decision IsolatedPolicy::decide(const core::DecisionRequest& request) {
  if (!process_) throw core::PolicyFailure(broke_between_);
  if (!broke_between_.empty()) return hold(std::exchange(broke_between_, ""));
  std::string why;
  try {
    return ask(request);
  } catch (const ProcessBroken& e) {
    why = e.what();
  } catch (const FlatError& e) {
    why = std::string("garbage came from its process in decide(): ") + e.what();
  }
  why += ", " + asked(request);
  recover(why);
  return hold(why);
}

core::Decision IsolatedPolicy::hold(const std::string& why) {
  core::Decision d;
  d.outcome = core::Outcome::hold;
  d.reason = choice_.name + " broke, and was started once more: " + why;
  d.log.push_back("warning: " + d.reason);
  return d;
}

void IsolatedPolicy::recover(const std::string& why) {
  process_.reset();
  if (choice_.output) choice_.output->note_break();
  std::string failure = choice_.name + ": " + why;
  if (!std::exchange(restarted_, true)) {
    try {
      return start();
    } catch (const std::exception& e) {
      process_.reset();
      failure += "; and it could not be started once more: " + std::string(e.what());
    }
  } else {
    failure += "; it had been started once more before";
  }
  broke_between_ = failure;
  throw core::PolicyFailure(failure);
}

void IsolatedPolicy::notify(const core::PolicyEvent& event) {
  if (!process_) return;
  std::string why;
  try {
    const RingMessage said = question("on_event", Said::event, flatten(event), nullptr);
    if (said.kind == static_cast<std::uint32_t>(Said::noted)) return;
    why = "it answered something else in on_event()";
  } catch (const ProcessBroken& e) {
    why = e.what();
  } catch (const FlatError& e) {
    why = std::string("garbage came from its process in on_event(): ") + e.what();
  }
  why += ", " + told(event);
  try {
    recover(why);
    broke_between_ = why;
  } catch (const core::PolicyFailure&) {  // the next decision reports it
  }
}

}  // namespace karst::host
