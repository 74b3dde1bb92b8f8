// Explores like the nearest frontier, and at a time of the mission goes wrong in the way it is told to.
#include <karst/ranking.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace {

class BreaksLater : public karst::Policy {
 public:
  void parameters(karst::Parameters& p) override {
    p.add("after", after_s_, "s", 0, 3600, "when it breaks, by the request's stamp");
    p.add("how", how_, "throws|crashes|spins|sleeps", "what it does then, whenever it is asked");
    ranking_.parameters(p);
  }

  karst::Decision decide(const karst::Request& request) override {
    if (1e-9 * static_cast<double>(request.stamp_ns) >= after_s_) break_down();
    return ranking_.decide(request, [](const karst::Frontier&) { return karst::Merit{0, "the nearest"}; });
  }

  void on_event(const karst::Event& event) override { ranking_.on_event(event); }

 private:
  void break_down() const {
    if (how_ == "throws") throw std::runtime_error("broke as it was told to");
    if (how_ == "crashes") std::raise(SIGSEGV);
    for (volatile unsigned i = 0;; i = i + 1)
      if (how_ == "sleeps") std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  double after_s_ = 20;
  std::string how_ = "throws";
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(BreaksLater, "breaks_later", "1.0.0", "For tests: explores, then throws, crashes or hangs.")
