// A request as bytes, with all the data it points to: for a policy in another process, and for a record that
// is replayed into a policy without a vehicle.
//
// Data that a policy cannot see is left out: only the class of the map's cells is written, and only the
// clearances of the roadmap, from which the reader builds the same one. A map may be written as its changes
// since an earlier one, which the reader must still hold. A survey never changes: with such changes, it is
// the one that the reader holds.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core_stack/mapping/frontiers/imaged_surface.h"
#include "core_stack/mission/policy/policy_port.h"
#include "sdk/host/serialization/flat_bytes.h"

namespace karst::host {

constexpr std::size_t kMaxRequestBytes = std::size_t{1} << 30;  // a map of 30 million m^3

/// The reader knows the request's map as of its write number `map_since`: only blocks changed after it are
/// written. 0: the whole map.
Bytes flatten(const core::DecisionRequest& request, std::uint64_t map_since = 0);

/// Writes length and checksum of the body into the header: the last step of flatten(), for callers that
/// change its bytes on purpose. `request` has at least the header's 32 bytes.
void seal(std::span<std::byte> request);

/// Reads requests one after the other, and keeps the last.
class RequestReader {
 public:
  /// The data kept up to date from request to request. A roadmap takes some time for a large map the first
  /// time; without it, `request().roadmap` is null.
  enum class Keeps { map, map_and_roadmap };
  explicit RequestReader(Keeps keeps) : keeps_(keeps) {}
  RequestReader(const RequestReader&) = delete;
  RequestReader& operator=(const RequestReader&) = delete;

  /// Throws FlatError for invalid bytes: truncated, damaged, of another version, or changes of a map other
  /// than the one kept. The map kept is then dropped, and the next request must contain the whole map.
  const core::DecisionRequest& read(std::span<const std::byte> bytes);
  const core::DecisionRequest& request() const { return request_; }

 private:
  void read_vehicle(FlatReader& in);
  void read_frontiers(FlatReader& in);
  void read_teammates(FlatReader& in);
  void read_map(FlatReader& in);
  void read_imaged(FlatReader& in);
  void read_survey(FlatReader& in);
  void update_roadmap(const core::PlanningOptions& options, std::span<const core::CellChange> changes);

  Keeps keeps_;
  std::optional<core::VoxelMap> map_;
  std::optional<core::Roadmap> roadmap_;
  core::VehicleDescription vehicle_;
  core::ImagedSurface imaged_;
  std::optional<core::SurveyedPassages> survey_;
  std::vector<core::FrontierCluster> clusters_;
  core::DecisionRequest request_;
};

}  // namespace karst::host
