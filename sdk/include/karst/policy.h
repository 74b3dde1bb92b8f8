// The C++ wrapper of the policy ABI. A policy derives from karst::Policy, implements decide() and registers:
//
//   class CommittedSegment : public karst::Policy {
//     karst::Decision decide(const karst::Request& request) override { ... }
//   };
//   KARST_POLICY(CommittedSegment, "onward", "1.0.0", "Flies straight on.")
//
// Everything here is compiled into the plugin: only the C ABI crosses to the host, never an exception.
#pragma once
#include <string>

#include <karst/parameters.h>
#include <karst/request.h>
#include <karst/types.h>

namespace karst {

class Policy {
 public:
  virtual ~Policy() = default;
  Policy() = default;
  Policy(const Policy&) = delete;
  Policy& operator=(const Policy&) = delete;

  /// Lists the fields that a mission file may set; their present values are the defaults.
  virtual void parameters(Parameters&) {}
  /// Called once the parameters are set. Throw karst::Error if they are inconsistent.
  virtual void init() {}
  virtual void activate() {}
  virtual Decision decide(const Request& request) = 0;
  /// The outcome of a goal, and other events. Ignore kinds you do not know.
  virtual void on_event(const Event&) {}
  virtual void deactivate() {}
};

}  // namespace karst

#include <karst/registration.h>
