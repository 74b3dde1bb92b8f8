// The C++ face of the policy ABI. A policy derives from karst::Policy, writes decide(), and registers itself:
//
//   class CommittedSegment : public karst::Policy {
//     karst::Decision decide(const karst::Request& request) override { ... }
//   };
//   KARST_POLICY(CommittedSegment, "onward", "1.0.0", "Flies straight on.")
//
// Everything here is compiled into the plugin; only the C ABI crosses to the host, and no exception does.
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

  /// Names the fields that a mission file may set; their values now are the defaults.
  virtual void parameters(Parameters&) {}
  /// Parameters are set. Throw karst::Error if they do not go together.
  virtual void init() {}
  virtual void activate() {}
  virtual Decision decide(const Request& request) = 0;
  /// What became of a goal, and other news. Ignore kinds you do not know.
  virtual void on_event(const Event&) {}
  virtual void deactivate() {}
};

}  // namespace karst

#include <karst/registration.h>
