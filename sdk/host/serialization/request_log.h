// The requests and events of a policy and its answers, in one file: `karst fly --record-requests` writes it,
// `karst policy replay` reads it.
//
// A sequence of records: four bytes of magic, kind, length, checksum of the payload, payload. First a header,
// then events and requests in order, each request followed by its answer. A request has the format of
// flat_request.h, its map as the changes since the previous request. All other payloads are JSON. The file of
// a killed flight may end with an incomplete record, which is skipped and counted.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "core_stack/mission/policy/policy_port.h"
#include "sdk/host/serialization/flat_request.h"

namespace karst::host {

constexpr const char* kRequestLogName = "requests.bin";  // in a run directory

/// Precedes each record's payload. A request contains its own checksum, so its `sum` is 0.
struct RecordFrame {
  std::uint32_t magic, kind;
  std::uint64_t length, sum;
};
constexpr std::uint32_t kRequestRecord = 2;  // its kind
RecordFrame frame_of(std::uint32_t kind, std::span<const std::byte> payload);

/// The policy to which the requests were sent.
struct RequestLogHeader {
  std::string policy, version;
  std::uint64_t seed = 1;  // of its random stream
  boost::property_tree::ptree parameters;
};

/// An answer as JSON, the same text for the same answer: every digit, but neither drawings nor log.
std::string answer_text(const core::Decision& decision);
/// An answer as a readable line; other text is returned unchanged.
std::string answer_line(const std::string& answer_text);

/// Forwards to another policy, and records requests, events and answers. A request is in the file before the
/// policy sees it.
class RecordingPolicy final : public core::PolicyPort {
 public:
  /// Throws core::InputError if the file cannot be written; so do later calls, if the disk is full.
  RecordingPolicy(core::PolicyPort& policy, const std::filesystem::path& file,
                  const RequestLogHeader& header);
  std::string name() const override { return policy_.name(); }
  core::Decision decide(const core::DecisionRequest& request) override;
  void notify(const core::PolicyEvent& event) override;

 private:
  void write(std::uint32_t kind, std::span<const std::byte> payload);
  void write(std::uint32_t kind, const std::string& payload);

  core::PolicyPort& policy_;
  std::string file_;
  std::ofstream out_;
  std::uint64_t map_revision_ = 0;  // of the last request's map; 0: none
};

/// Reads such a file from its beginning.
class RequestLogReader {
 public:
  /// Throws core::InputError with file, byte and reason; next() does so, too.
  explicit RequestLogReader(const std::filesystem::path& file,
                            RequestReader::Keeps keeps = RequestReader::Keeps::map_and_roadmap);

  const RequestLogHeader& header() const { return header_; }
  enum class Kind { request, answer, event, end };
  /// Reads the next record; the accessors then return its content.
  Kind next();
  const core::DecisionRequest& request() const { return requests_.request(); }
  const std::string& answer() const { return answer_; }
  const core::PolicyEvent& event() const { return event_; }
  /// At the end: number of bytes of an incomplete last record.
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }

 private:
  struct Record {
    std::uint32_t kind;
    Bytes payload;
  };
  std::optional<Record> read();
  [[noreturn]] void fail(const std::string& why) const;

  std::string file_;
  std::ifstream in_;
  std::uint64_t size_ = 0, at_ = 0, record_ = 0, skipped_bytes_ = 0;
  RequestLogHeader header_;
  RequestReader requests_;
  std::string answer_;
  core::PolicyEvent event_{};
};

}  // namespace karst::host
