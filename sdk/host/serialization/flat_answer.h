// The messages between the host and a policy's process other than requests, as bytes.
//
// Data from the policy's process is not trusted: reading an answer yields core types that satisfy the same
// rules as an answer in process, or a FlatError.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/policy/policy_port.h"
#include "sdk/host/serialization/flat_bytes.h"
#include "sdk/host/services/path_question.h"

namespace karst::host {

/// Kinds of messages. Each host message except `end` is answered by one policy message, `start` by up to two;
/// before it answers, the policy's process may ask for lengths and paths.
enum class Said : std::uint32_t {
  start = 1,           // StartOrder -> unconfined; or confined, and then ready, refused
  decide = 2,          // a request (flat_request.h) -> decided, gave_up
  event = 3,           // -> noted
  lengths = 4,         // the answer to asks_lengths
  end = 5,             // deactivate, destroy, exit
  paths = 6,           // the answer to asks_paths
  ready = 101,         // ReadyReport
  refused = 102,       // a text: bad input
  decided = 103,       // DecisionReport
  gave_up = 104,       // a text: a PolicyFailure
  noted = 105,         // nothing
  asks_lengths = 106,  // LengthsQuestion
  asks_paths = 107,    // LengthsQuestion
  confined = 108,      // nothing: the plugin is opened next
  unconfined = 109     // a text: why this machine cannot confine a process
};

constexpr std::size_t kMaxAnswerBytes = 32u << 20;  // a state of 16 MiB, drawings of 5 MB, texts

/// The data that a policy object leaves to the one started in its place.
struct PolicyLegacy {
  std::uint64_t numbers_drawn = 0;  // from the host's random stream
  std::optional<Bytes> state;       // "karst.state/1"
};

struct StartOrder {
  std::string file, policy, source;
  boost::property_tree::ptree parameters;
  std::uint64_t seed = 1;
  int failures_allowed = 2;
  std::uint64_t memory_limit_bytes = 0;
  PolicyLegacy legacy;
};
struct ReadyReport {
  std::string version;
  boost::property_tree::ptree parameters;
};
struct DecisionReport {
  core::Decision decision;
  PolicyLegacy legacy;
};
struct LengthsQuestion {
  core::Vec3 from = core::Vec3::Zero();
  std::vector<core::Vec3> goals;
  double tolerance_m = 0;
};

Bytes flatten(const StartOrder& order);
StartOrder read_start_order(std::span<const std::byte> bytes);
Bytes flatten(const ReadyReport& report);
ReadyReport read_ready_report(std::span<const std::byte> bytes);
Bytes flatten(const DecisionReport& report);
DecisionReport read_decision_report(std::span<const std::byte> bytes);
Bytes flatten(const core::PolicyEvent& event);
core::PolicyEvent read_event(std::span<const std::byte> bytes);
Bytes flatten(const LengthsQuestion& question);
LengthsQuestion read_lengths_question(std::span<const std::byte> bytes);
Bytes flatten(const PathAnswer& answer);
PathAnswer read_path_answer(std::span<const std::byte> bytes);
Bytes flatten(const PathsAnswer& answer);
PathsAnswer read_paths_answer(std::span<const std::byte> bytes);
Bytes flatten(const std::string& text);
/// Cleaned: one line of UTF-8.
std::string read_text(std::span<const std::byte> bytes);

}  // namespace karst::host
