// The C++ face: an exception from init(), and one that is no std::exception from decide().
#include <karst/policy.h>

namespace {
class Throwing : public karst::Policy {
  void parameters(karst::Parameters& p) override { p.add("fail", fail_, "init|decide", "where to throw"); }
  void init() override {
    if (fail_ == "init") throw karst::Error("these parameters do not go together");
  }
  karst::Decision decide(const karst::Request&) override { throw 42; }
  std::string fail_ = "decide";
};
}  // namespace
KARST_POLICY(Throwing, "throwing_init", "1.0.0", "Throws.")
