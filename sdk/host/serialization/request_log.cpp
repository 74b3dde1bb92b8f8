#include "sdk/host/serialization/request_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"

namespace karst::host {
namespace {

using core::InputError;
using nlohmann::ordered_json;

constexpr std::uint32_t kMagic = 0x6c71726b;  // "krql"
enum : std::uint32_t { kHeader = 1, kRequest = kRequestRecord, kAnswer = 3, kEvent = 4 };
constexpr int kSchema = 1;
constexpr std::uint64_t kMaxText = 1u << 20;  // bytes of a record that is JSON

/// FNV-1a. 0 for a request, which contains its own checksum.
std::uint64_t sum_of(std::uint32_t kind, std::span<const std::byte> payload) {
  if (kind == kRequest) return 0;
  std::uint64_t hash = 14695981039346656037ull;
  for (const std::byte b : payload) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211ull;
  return hash;
}

ordered_json to_json(const core::Goal& g) {
  ordered_json j{{"position", {g.position.x(), g.position.y(), g.position.z()}},
                 {"heading", g.heading_rad},  // NaN, which means any, becomes null
                 {"tolerance", g.tolerance_m},
                 {"max_speed", g.max_speed_mps},
                 {"frontier", g.frontier_id},
                 {"score", g.score},
                 {"why", g.why}};
  return j;
}

core::Goal goal_of(const ordered_json& j) {
  core::Goal g;
  const ordered_json& p = j.at("position");
  g.position = {p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()};
  const ordered_json& heading = j.at("heading");
  g.heading_rad = heading.is_null() ? std::numeric_limits<double>::quiet_NaN() : heading.get<double>();
  g.tolerance_m = j.at("tolerance");
  g.max_speed_mps = j.at("max_speed");
  g.frontier_id = j.at("frontier");
  g.score = j.at("score");
  g.why = j.at("why");
  return g;
}

RequestLogHeader header_of(const ordered_json& j) {
  if (j.at("schema") != kSchema) throw std::runtime_error("it is of another version");
  RequestLogHeader h;
  h.policy = j.at("policy");
  h.version = j.at("version");
  h.seed = j.at("seed");
  for (const auto& [id, value] : j.at("parameters").items())
    h.parameters.push_back({id, boost::property_tree::ptree(value.get<std::string>())});
  return h;
}

core::PolicyEvent event_of(const ordered_json& j) {
  core::PolicyEvent e{};
  const std::string kind = j.at("kind");
  const auto parsed = core::parse<core::PolicyEvent::Kind>(kind);
  if (!parsed) throw std::runtime_error("unknown event " + kind);
  e.kind = *parsed;
  e.stamp = j.at("stamp"), e.goal = goal_of(j.at("goal")), e.reason = j.at("reason");
  return e;
}

std::string_view text_in(std::span<const std::byte> payload) {
  return {reinterpret_cast<const char*>(payload.data()), payload.size()};
}

ordered_json json_in(std::span<const std::byte> payload) {
  ordered_json j = core::json_of<ordered_json>(text_in(payload));
  if (j.is_discarded()) throw std::runtime_error("it is no JSON");
  return j;
}

}  // namespace

RecordFrame frame_of(std::uint32_t kind, std::span<const std::byte> payload) {
  return {kMagic, kind, payload.size(), sum_of(kind, payload)};
}

std::string answer_text(const core::Decision& d) {
  ordered_json goals = ordered_json::array();
  for (const core::Goal& g : d.goals) goals.push_back(to_json(g));
  return core::json_text(
      ordered_json{{"outcome", core::name_of(d.outcome)}, {"reason", d.reason}, {"goals", goals}});
}

std::string answer_line(const std::string& text) try {
  const ordered_json j = core::json_of<ordered_json>(text);
  if (j.contains("failure")) return "failed: " + j.at("failure").get<std::string>();
  std::string out = j.at("outcome");
  if (const std::string reason = j.at("reason"); !reason.empty()) out += ": " + reason;
  const ordered_json& goals = j.at("goals");
  if (goals.empty()) return out;
  const core::Goal g = goal_of(goals.front());
  std::array<char, 160> first;
  std::snprintf(first.data(), first.size(), " (%.2f %.2f %.2f), frontier %u, score %.3f, ", g.position.x(),
                g.position.y(), g.position.z(), g.frontier_id, g.score);
  return out + first.data() + g.why +
         (goals.size() > 1 ? ", and " + std::to_string(goals.size() - 1) + " more" : "");
} catch (const ordered_json::exception&) {
  return text;
}

RecordingPolicy::RecordingPolicy(core::PolicyPort& policy, const std::filesystem::path& file,
                                 const RequestLogHeader& h)
    : policy_(policy), file_(file.string()), out_(file, std::ios::binary) {
  ordered_json parameters = ordered_json::object();
  for (const auto& [id, value] : h.parameters) parameters[id] = value.data();
  write(kHeader, core::json_text(ordered_json{{"schema", kSchema},
                                              {"policy", h.policy},
                                              {"version", h.version},
                                              {"seed", h.seed},
                                              {"parameters", parameters}}));
}

void RecordingPolicy::write(std::uint32_t kind, std::span<const std::byte> payload) {
  const RecordFrame frame = frame_of(kind, payload);
  out_.write(reinterpret_cast<const char*>(&frame), sizeof frame);
  out_.write(reinterpret_cast<const char*>(payload.data()), static_cast<std::streamsize>(payload.size()));
  if (!out_.flush()) throw InputError(file_, "", "cannot be written");
}
void RecordingPolicy::write(std::uint32_t kind, const std::string& payload) {
  write(kind, std::as_bytes(std::span(payload)));
}

core::Decision RecordingPolicy::decide(const core::DecisionRequest& request) {
  write(kRequest, flatten(request, map_revision_));
  map_revision_ = request.map == nullptr ? 0 : request.map->revision();
  try {
    core::Decision decision = policy_.decide(request);
    write(kAnswer, answer_text(decision));
    return decision;
  } catch (const core::PolicyFailure& failure) {
    write(kAnswer, core::json_text(ordered_json{{"failure", failure.what()}}));
    throw;
  }
}

void RecordingPolicy::notify(const core::PolicyEvent& e) {
  write(kEvent, core::json_text(ordered_json{{"kind", core::name_of(e.kind)},
                                             {"stamp", e.stamp},
                                             {"goal", to_json(e.goal)},
                                             {"reason", e.reason}}));
  policy_.notify(e);
}

RequestLogReader::RequestLogReader(const std::filesystem::path& file, RequestReader::Keeps keeps)
    : file_(file.string()),
      in_(core::open_input(file_, core::kMaxDataFileBytes)),
      size_(std::filesystem::file_size(file)),
      requests_(keeps) {
  const std::optional<Record> first = read();
  if (!first || first->kind != kHeader) fail("a record of requests begins with whom they were put to");
  try {
    header_ = header_of(json_in(first->payload));
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void RequestLogReader::fail(const std::string& why) const {
  throw InputError(file_, "record " + std::to_string(record_) + ", which ends at byte " + std::to_string(at_),
                   why);
}

std::optional<RequestLogReader::Record> RequestLogReader::read() {
  ++record_;
  RecordFrame frame{};
  if (size_ - at_ < sizeof frame) {
    skipped_bytes_ = size_ - at_;
    return std::nullopt;
  }
  in_.read(reinterpret_cast<char*>(&frame), sizeof frame);
  at_ += sizeof frame;
  if (!in_ || frame.magic != kMagic) fail("this is no record of requests, or it is damaged");
  if (frame.length > (frame.kind == kRequest ? kMaxRequestBytes : kMaxText))
    fail("it is longer than it can be");
  if (frame.length > size_ - at_) {  // the flight was killed while it was written
    skipped_bytes_ = sizeof frame + size_ - at_;
    return std::nullopt;
  }
  Record out{frame.kind, Bytes(frame.length)};
  in_.read(reinterpret_cast<char*>(out.payload.data()), static_cast<std::streamsize>(frame.length));
  at_ += frame.length;
  if (!in_) fail("it cannot be read");
  if (sum_of(frame.kind, out.payload) != frame.sum) fail("it is damaged: the sum over its bytes is wrong");
  return out;
}

RequestLogReader::Kind RequestLogReader::next() {
  const std::optional<Record> record = read();
  if (!record) return Kind::end;
  try {
    switch (record->kind) {
      case kRequest:
        requests_.read(record->payload);
        return Kind::request;
      case kAnswer:
        answer_ = text_in(record->payload);
        return Kind::answer;
      case kEvent:
        event_ = event_of(json_in(record->payload));
        return Kind::event;
      default:
        fail("it is of a kind that this karst does not know");
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

}  // namespace karst::host
