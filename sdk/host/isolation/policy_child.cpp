#include "sdk/host/isolation/policy_child.h"

#include <memory>
#include <mutex>

#include "sdk/host/in_process/loaded_policy.h"
#include "sdk/host/isolation/file_access.h"
#include "sdk/host/isolation/sandbox.h"
#include "sdk/host/isolation/shared_ring.h"
#include "sdk/host/plugin/selection.h"
#include "sdk/host/serialization/flat_answer.h"
#include "sdk/host/serialization/flat_request.h"

namespace karst::host {
namespace {

class Server {
 public:
  Server(const RingMemory& own, const RingMemory& hosts)
      : ring_(own, hosts, [] {}), requests_(RequestReader::Keeps::map) {}

  int run() {
    start();
    for (;;) {
      const RingMessage m = ring_.receive(kMaxRequestBytes);
      switch (static_cast<Said>(m.kind)) {
        case Said::decide:
          decide(m.body);
          break;
        case Said::event:
          policy_->notify(read_event(m.body));
          say(Said::noted, {});
          break;
        case Said::end:
          policy_.reset();
          return 0;
        default:
          return 1;
      }
    }
  }

 private:
  void say(Said kind, const Bytes& body) { ring_.send(static_cast<std::uint32_t>(kind), body); }

  void start() {
    const StartOrder order = read_start_order(ring_.receive(kMaxRequestBytes).body);
    PolicyChoice choice;
    choice.name = order.policy;
    choice.parameters = order.parameters;
    choice.source = order.source;
    choice.seed = order.seed;
    choice.isolation = Isolation::process;
    choice.failures_allowed = order.failures_allowed;
    choice.hang_limit_s = choice.cpu_limit_s = 1e9;  // the host enforces them: it can end this process
    try {
      confine_this_process(order.memory_limit_bytes, places_to_read(order.file));
    } catch (const std::exception& e) {
      say(Said::unconfined, flatten(std::string(e.what())));
      return;
    }
    say(Said::confined, {});
    try {
      const Selection found = open_policy(order.file, order.policy);
      policy_ = std::make_unique<LoadedPolicy>(
          found.plugin, *found.policy, choice, order.legacy,
          [this](const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m) {
            return lengths(from, goals, tolerance_m);
          },
          [this](const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m) {
            return paths(from, goals, tolerance_m);
          });
    } catch (const std::exception& e) {
      say(Said::refused, flatten(std::string(e.what())));
      return;
    }
    say(Said::ready, flatten(ReadyReport{policy_->version(), policy_->parameters()}));
  }

  void decide(const Bytes& body) {
    const core::DecisionRequest& request = requests_.read(body);
    DecisionReport report;
    try {
      report.decision = policy_->decide(request);
    } catch (const core::PolicyFailure& e) {
      say(Said::gave_up, flatten(std::string(e.what())));
      return;
    }
    report.legacy = policy_->legacy();
    say(Said::decided, flatten(report));
  }

  /// Queries the host. Runs on a thread of the policy, while the main thread waits for decide() to return.
  PathAnswer lengths(const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m) {
    const std::lock_guard lock(asking_);
    say(Said::asks_lengths, flatten(LengthsQuestion{from, {goals.begin(), goals.end()}, tolerance_m}));
    return read_path_answer(ring_.receive(kMaxAnswerBytes).body);
  }

  PathsAnswer paths(const core::Vec3& from, std::span<const core::Vec3> goals, double tolerance_m) {
    const std::lock_guard lock(asking_);
    say(Said::asks_paths, flatten(LengthsQuestion{from, {goals.begin(), goals.end()}, tolerance_m}));
    return read_paths_answer(ring_.receive(kMaxAnswerBytes).body);
  }

  RingEnd ring_;
  RequestReader requests_;
  std::mutex asking_;
  std::unique_ptr<LoadedPolicy> policy_;
};

}  // namespace

int serve_policy() {
  RingMemory hosts(kRequestsDescriptor, RingMemory::Access::read);
  RingMemory own(kAnswersDescriptor, RingMemory::Access::write);
  hosts.close_descriptor(), own.close_descriptor();
  return Server(own, hosts).run();
}

}  // namespace karst::host
