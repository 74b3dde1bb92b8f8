// A request as bytes, with all that it points to: for a policy in another process, and for a record that is
// played back into a policy without a vehicle.
//
// What a policy cannot see is left out: of the map's cells only the class goes, of the roadmap only the
// clearances from which the same one is built. A map may go as what changed since a former one, which
// whoever reads it must still hold.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core_stack/mapping/frontiers/imaged_surface.h"
#include "core_stack/mission/policy/policy_port.h"
#include "sdk/host/serialization/flat_bytes.h"

namespace karst::host {

/// The request's map as of its write number `map_since` is known to the reader: only blocks changed after it
/// are written. 0: all of it.
Bytes flatten(const core::DecisionRequest& request, std::uint64_t map_since = 0);

/// Writes length and sum of what follows the header into it: the last step of flatten(), for who changes its
/// bytes on purpose. `request` has a header's 32 bytes at least.
void seal(std::span<std::byte> request);

/// Reads requests one after the other, and holds the last.
class RequestReader {
 public:
  /// What is kept up to date from request to request. A roadmap takes some time for a large map the first
  /// time; without, `request().roadmap` is null.
  enum class Keeps { map, map_and_roadmap };
  explicit RequestReader(Keeps keeps) : keeps_(keeps) {}
  RequestReader(const RequestReader&) = delete;
  RequestReader& operator=(const RequestReader&) = delete;

  /// Throws FlatError for bytes that flatten() did not write so: cut short, damaged, of another version, or
  /// changes of a map that is not the one held. Whatever was held is then gone: the next must be whole.
  const core::DecisionRequest& read(std::span<const std::byte> bytes);
  const core::DecisionRequest& request() const { return request_; }

 private:
  void read_vehicle(FlatReader& in);
  void read_frontiers(FlatReader& in);
  void read_teammates(FlatReader& in);
  void read_map(FlatReader& in);
  void read_imaged(FlatReader& in);
  void update_roadmap(const core::PlanningOptions& options, std::span<const core::CellChange> changes);

  Keeps keeps_;
  std::optional<core::VoxelMap> map_;
  std::optional<core::Roadmap> roadmap_;
  core::VehicleDescription vehicle_;
  core::ImagedSurface imaged_;
  std::vector<core::FrontierCluster> clusters_;
  core::DecisionRequest request_;
};

}  // namespace karst::host
