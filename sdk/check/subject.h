// The policy under test: one object, called function by function on this thread.
#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "sdk/check/progress.h"
#include "sdk/host/boundary/decision_box.h"
#include "sdk/host/plugin/plugin_file.h"
#include "sdk/host/services/session.h"

namespace karst::check {

/// basic: required for flight. strict: expected of a policy given to others. pedantic: tidiness.
enum class Level { basic, strict, pedantic };
constexpr auto names_of(Level) {
  using enum Level;
  return std::to_array<core::Named<Level>>({{basic, "basic"}, {strict, "strict"}, {pedantic, "pedantic"}});
}

/// Thrown by a test with a one-line reason.
struct Failed {
  std::string reason;
};
/// Thrown if the policy does not offer the feature under test.
struct NotApplicable {
  std::string reason;
};

/// The inputs of a test.
struct Context {
  std::string file;
  std::string karst;                       // the executable, for a second process
  const karst_policy_t* policy = nullptr;  // null for tests of the file as a whole
  std::string id;
  std::uint64_t seed = 1;
  Level level = Level::strict;
  Progress* progress = nullptr;
  nlohmann::ordered_json figures = nlohmann::ordered_json::object();  // measured values
};

/// The result of one decide().
struct Answer {
  std::string failure;  // of the call itself: an error or exception; not a refusal by the sink
  host::DecisionBox box;
  double cpu_s = 0, wall_s = 0;  // time of this thread

  bool good() const { return failure.empty() && box.fault().empty(); }
  std::string fault() const { return failure.empty() ? box.fault() : failure; }
  /// The complete answer with all digits, for comparison.
  std::string text() const;
};

class Object {
 public:
  /// Calls create(). `host` is the policy's view of `session`; by default the session's own.
  Object(Context& context, host::Session& session, const karst_host_t* host = nullptr);
  /// Calls destroy(), unless already called.
  ~Object();
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  // Each returns "" or why the call failed.
  std::string create_fault() const { return create_fault_; }
  std::string init(const std::vector<karst_parameter_value_t>& values);
  std::string activate();
  std::string deactivate();
  std::string destroy();
  std::string event(const karst_event_t& event);
  std::string save(std::vector<std::byte>& bytes);
  std::string restore(const std::vector<std::byte>& bytes);

  Answer decide(const core::DecisionRequest& request);
  /// Null if the policy does not offer "karst.state/1".
  const karst_state_extension_t* state();
  void* self() const { return self_; }
  /// Changes of the process made by calls, which were reverted.
  const std::vector<std::string>& changes() const { return changes_; }

 private:
  template <class Work>
  std::string call(const std::string& slot, Work work);

  Context& context_;
  host::Session& session_;
  const karst_host_t* host_;
  void* self_ = nullptr;
  std::string create_fault_;
  std::vector<std::string> changes_;
};

/// The declared defaults, as views of the descriptor.
std::vector<karst_parameter_value_t> defaults(const karst_policy_t& policy);

/// Brings a new object from created through initialized to active. Throws Failed.
std::unique_ptr<Object> started(Context& context, host::Session& session, const karst_host_t* host = nullptr);
/// A session with this test's seed; this thread is its decision thread.
std::unique_ptr<host::Session> new_session(const Context& context);
/// Throws Failed, prefixed with `where`, unless `fault` is "".
void require(const std::string& fault, const std::string& where = "");

}  // namespace karst::check
