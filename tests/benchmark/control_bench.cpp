// Control: the tracker's solver next to NLopt's SLSQP on the same problems, the SE(3) controller, the
// estimator.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/control/jerk_mpc.h"
#include "core_stack/control/mpc_tracker.h"
#include "core_stack/control/se3_controller.h"
#include "core_stack/localization/estimator.h"
#include "tests/unit/control/slsqp_oracle.h"

namespace karst::core {
namespace {

double run_us(const std::function<void()>& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
}

struct Times {
  double mean = 0, median = 0, p99 = 0, worst = 0;
};

Times summary(std::vector<double> us) {
  std::sort(us.begin(), us.end());
  Times t;
  for (const double u : us) t.mean += u / static_cast<double>(us.size());
  t.median = us[us.size() / 2], t.p99 = us[us.size() * 99 / 100], t.worst = us.back();
  return t;
}

void print(const char* name, const Times& t) {
  std::printf("%-44s mean %9.1f  median %9.1f  p99 %9.1f  max %9.1f us\n", name, t.mean, t.median, t.p99,
              t.worst);
}

/// Waypoints some metres apart, reached at up to 1.9 m/s and left again without a stop.
std::vector<MotionTarget> targets_at(const JerkMpcSetup& s, double now_s) {
  std::vector<MotionTarget> out;
  for (int k = 1; k <= s.steps; ++k) {
    const double t = now_s + k * s.step_s, w = 0.55;
    out.push_back({{3.0 * std::sin(w * t), 1.5 * std::sin(2 * w * t), 0.5 * std::sin(0.7 * t)},
                   {3.0 * w * std::cos(w * t), 3.0 * w * std::cos(2 * w * t), 0.35 * std::cos(0.7 * t)}});
  }
  return out;
}

void solver() {
  const JerkMpcSetup setup;
  JerkMpc warm(setup), cold(setup);
  Motion m;
  std::vector<double> warm_us, cold_us, slsqp_us;
  double iterations = 0, unfinished = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const auto targets = targets_at(setup, 0.01 * i);
    warm_us.push_back(run_us([&] { warm.solve(m, targets, i == 0 ? -1 : 0.01); }));
    iterations += warm.plan().iterations, unfinished += !warm.plan().converged;
    if (i % 50 == 0) {
      cold_us.push_back(run_us([&] { cold.solve(m, targets, -1); }));
      const test::DenseProblem dense(setup, m, targets);
      slsqp_us.push_back(run_us([&] { test::solve_with_slsqp(dense, 1e-6, 500); }));
    }
    m = advanced(m, warm.plan().jerk_mps3[0], 0.01);
  }
  std::printf("MPC, 3 axes, %d steps; %.2f iterations a solution, %.2f %% given up\n", setup.steps,
              iterations / n, 100 * unfinished / n);
  const Times w = summary(warm_us), c = summary(cold_us), s = summary(slsqp_us);
  print("  interior point, warm", w);
  print("  interior point, cold", c);
  print("  NLopt SLSQP, cold", s);
  std::printf("  SLSQP / interior point (medians): warm %.0f, cold %.0f\n", s.median / w.median,
              s.median / c.median);
}

void tracker() {
  MpcTracker t({}, {});
  t.reset(0, Vec3::Zero(), 0);
  Trajectory trajectory;
  for (int i = 0; i < 600; ++i) {
    const double s = i * seconds(trajectory.period);
    trajectory.samples.push_back({{3.0 * std::sin(0.55 * s), 1.5 * std::sin(1.1 * s), 0}, 0});
  }
  std::vector<double> us;
  for (TimeNs now = 10 * kMillisecond; now < 30 * kSecond; now += 10 * kMillisecond)
    us.push_back(run_us([&] { t.step(trajectory, now); }));
  print("tracker, one 10 ms step", summary(us));
}

void controller() {
  Se3Controller c({}, 2, 45, 6);
  Random r(1);
  State s;
  Reference ref;
  double sum = 0;
  const int n = 1000000;
  const double us = run_us([&] {
    for (int i = 0; i < n; ++i) {
      ref.position.x() = 0.1 * (i % 7);
      sum += c.update(s, ref, 0.01).thrust_n;
    }
  });
  std::printf("SE(3) controller %.0f ns an update (checksum %.3f)\n", 1000 * us / n, sum / n);
}

void estimator() {
  Estimator e({}, {});
  Random r(1);
  const int n = 200000;
  const double us = run_us([&] {
    for (int i = 0; i < n; ++i) {
      const TimeNs now = i * 5 * kMillisecond;
      e.on_imu({now, Vec3(0, 0, 9.81), Vec3(0.01, 0, 0)});
      if (i % 5 == 0 && i > 20) e.on_pose({now - 50 * kMillisecond, {Vec3(0.01, 0, 0), Quat::Identity()}});
    }
  });
  std::printf("estimator %.2f us an IMU sample, with 40 poses a second, 50 ms late (z %.3f)\n", us / n,
              e.state().position.z());
}

}  // namespace
}  // namespace karst::core

int main() {
  karst::core::solver();
  karst::core::tracker();
  karst::core::controller();
  karst::core::estimator();
}
