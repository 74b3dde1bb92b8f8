#include "sdk/live/live_flight.h"

#include <exception>
#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"

namespace karst::live {
namespace {

LiveSetup checked(LiveSetup setup) {
  if (!setup.token.empty() && !is_token(setup.token))
    throw core::InputError("karst fly", "--live-token",
                           "a token has at least 8 characters: letters, digits and -._~");
  if (setup.token.empty() && !is_loopback(setup.endpoint))
    throw core::InputError("karst fly", "--live=" + text_of(setup.endpoint),
                           "others can reach this address: add --live-token TOKEN, which they then give");
  return setup;
}

}  // namespace

LiveFlight::LiveFlight(LiveSetup setup, double map_resolution_m, std::filesystem::path stored_map)
    : log_(setup.log),
      stored_map_(std::move(stored_map)),
      server_(checked(std::move(setup)), Retained(flight_topics(), map_topic())),
      messages_(map_resolution_m, [this](const LiveMessage& m) { server_.publish(m); }),
      thread_([this] { run(); }) {}

LiveFlight::~LiveFlight() {
  over_ = true;
  thread_.join();
}

void LiveFlight::run() noexcept {
  try {
    server_.run([this] { return tick(); });
  } catch (const std::exception& e) {  // the flight goes on
    log_(std::string("serves no more: ") + e.what());
  }
}

void LiveFlight::end() {
  std::optional<core::VoxelMap> stored;
  if (!stored_map_.empty() && std::filesystem::exists(stored_map_)) try {
      stored.emplace(core::read_octomap(stored_map_.string()));
    } catch (const core::InputError& e) {
      log_(e.what());
    }
  messages_.end(stored ? &*stored : nullptr);
}

bool LiveFlight::tick() {
  const bool over = over_;
  const RecordFeed::Progress progress = feed_.read([this](core::RecordPart part, std::string_view bytes) {
    try {
      messages_.take(part, bytes);
    } catch (const std::runtime_error& e) {
      log_(e.what());
    }
  });
  if (progress.lost > lost_) {
    lost_ = progress.lost;
    server_.tell(
        StatusLevel::warning,
        std::to_string(lost_) + " records came faster than they could be served: the map may lack cells",
        "lost");
  }
  if (progress.closed && !std::exchange(ended_, true)) end();
  if (const std::uint64_t now_ns = messages_.time_ns(); now_ns > told_ns_) {
    told_ns_ = now_ns;
    server_.tell_time(now_ns);
  }
  return !over;
}

}  // namespace karst::live
