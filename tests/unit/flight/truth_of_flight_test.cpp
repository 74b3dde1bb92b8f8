#include "sdk/flight/truth_of_flight.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core_stack/common/error.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

/// A run, and the folder that a vehicle's own process would have written of it.
class TruthOfFlight : public ::testing::Test {
 protected:
  TruthOfFlight() {
    test::write_fake_run(run_);
    fs::create_directories(truth_);
    for (const char* file : {"mission.info", "ground_truth.tum"}) fs::copy_file(run_ / file, truth_ / file);
  }
  std::string refusal() const {
    try {
      check_same_flight(run_, truth_);
    } catch (const core::InputError& e) {
      return e.what();
    }
    return "";
  }
  /// Writes the truth anew, each line by `change`: the numbers of a pose, time first.
  template <class Change>
  void change_truth(Change change) const {
    std::ifstream in(run_ / "ground_truth.tum");
    std::ostringstream out;
    for (std::string line; std::getline(in, line);) {
      std::istringstream numbers(line);
      std::vector<double> pose;
      for (double v = 0; numbers >> v;) pose.push_back(v);
      if (pose.size() != 8 || !change(pose)) continue;
      for (const double v : pose) out << v << ' ';
      out << '\n';
    }
    std::ofstream(truth_ / "ground_truth.tum") << out.str();
  }

  const test::TemporaryDirectory dir_;
  const fs::path run_ = dir_.path() / "run", truth_ = dir_.path() / "truth";
};

TEST_F(TruthOfFlight, IsTakenIfSeedStartAndPathAgree) {
  EXPECT_EQ(refusal(), "");
  change_truth([](std::vector<double>& pose) {
    pose[0] += pose[0] > 20 ? 2.4 : 0.4;  // another clock, which stood still
    return true;
  });
  EXPECT_EQ(refusal(), "");
}

TEST_F(TruthOfFlight, OfAnotherSeedIsRefused) {
  std::ofstream(truth_ / "mission.info") << "seed 8\n";
  EXPECT_EQ(refusal(), truth_.string() + ": is the truth of another flight than " + run_.string() +
                           ": its seed is 8, and not 7");
}

TEST_F(TruthOfFlight, ThatBeginsElsewhereIsRefused) {
  change_truth([](std::vector<double>& pose) {
    pose[2] += 3;
    return true;
  });
  EXPECT_NE(refusal().find("it begins at (0.0, 3.0, "), std::string::npos) << refusal();
}

TEST_F(TruthOfFlight, WithALongerOrShorterPathIsRefusedUnlessTheFlightWasCutOff) {
  change_truth([](const std::vector<double>& pose) { return pose[0] < 40; });
  EXPECT_NE(refusal().find("its path is "), std::string::npos) << refusal();
  std::ofstream(run_ / "events.jsonl") << "";
  EXPECT_EQ(refusal(), "") << "a core or a vehicle that is gone";
}

}  // namespace
}  // namespace karst::flight
