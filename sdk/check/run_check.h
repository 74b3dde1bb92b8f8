// Runs the tests of a plugin, each in its own child process: a test can only damage its own process.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/check/tests.h"

namespace karst::check {

struct CheckOptions {
  std::string file;
  std::string policy;  // "": every policy of the file
  std::uint64_t seed = 1;
  Level level = Level::strict;
  std::vector<std::string> tests;  // names or groups; empty: all tests of the level
  double hang_limit_s = 10;        // for one call into the plugin
  std::filesystem::path karst;     // the executable, for the children
  const std::atomic<bool>* stop = nullptr;
};

enum class Verdict { passed, noted, failed, not_applicable, not_run };
constexpr auto names_of(Verdict) {
  using enum Verdict;
  return std::to_array<core::Named<Verdict>>({{passed, "passed"},
                                              {noted, "note"},
                                              {failed, "failed"},
                                              {not_applicable, "not applicable"},
                                              {not_run, "not run"}});
}

struct TestResult {
  const Test* test = nullptr;
  std::string policy;  // "" for a test of the file
  Verdict verdict = Verdict::passed;
  std::string reason;  // empty if passed
  nlohmann::ordered_json figures;
  double wall_s = 0;
  std::string repeat;  // the command that repeats this test alone, in the same way
};

/// Calls `done` after each test. If stopped, terminates the running test and leaves it out. Throws
/// core::InputError if the file cannot be read, if a policy or a test does not exist, or if tests of policies
/// are selected and the file offers none.
std::vector<TestResult> run_check(const CheckOptions& options,
                                  const std::function<void(const TestResult&)>& done);

/// In a child: runs one test and writes its result to the folder `work`.
void run_test(Context& context, const Test& test, const std::filesystem::path& work);

/// In a child: opens the file and selects the policy. Throws core::InputError.
void choose_policy(Context& context);

}  // namespace karst::check
