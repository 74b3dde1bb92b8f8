// One client's side of the protocol, without its socket: what it has subscribed to, and what is to be sent to
// it.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "sdk/live/foxglove.h"
#include "sdk/live/outbox.h"
#include "sdk/live/retained.h"

namespace karst::live {

struct Frame {
  bool binary = false;
  std::optional<MessageHead> head;  // stands before the bytes
  std::shared_ptr<const std::string> bytes;
};

class ClientSession {
 public:
  /// Of requests that make no sense, this many are answered; after the next the client is to be left.
  static constexpr int kMaxRefused = 20;
  /// Texts that wait to be sent; a client that has asked for more is to be left.
  static constexpr std::size_t kMaxTexts = 64;

  /// `retained` outlives the session. The greeting is what the client gets first.
  ClientSession(const Retained& retained, std::string server_info);

  /// What the client has sent as a text.
  void receive(std::string_view text);
  /// What it has sent as bytes: there is no such request.
  void receive_binary() { refuse("this server takes no messages"); }
  /// Why the client is to be left; "" if it behaves.
  const std::string& complaint() const { return complaint_; }

  void publish(const LiveMessage& message);
  void tell_time(std::uint64_t time_ns) { time_ns_ = time_ns; }
  void tell(StatusLevel level, const std::string& text, const std::string& id = "");
  /// What has been dropped since the last time becomes part of what is sent next.
  void tell_dropped() { tells_dropped_ = true; }

  /// The next frame to send; none if nothing waits.
  std::optional<Frame> next();
  bool idle() const { return texts_.empty() && outbox_.empty(); }
  std::size_t subscriptions() const { return subscriptions_.size(); }
  std::size_t waiting_bytes() const { return outbox_.bytes(); }
  std::uint64_t dropped() const;  // messages so far

 private:
  void take(const Subscribe& request);
  void take(const Unsubscribe& request);
  void take(const Refused& refused) { refuse(refused.reason); }
  void refuse(const std::string& why);
  void text(std::string bytes);
  std::optional<std::string> dropped_text();

  const Retained& retained_;
  std::map<std::size_t, std::uint32_t> subscriptions_;  // of each topic, at most one
  std::deque<std::string> texts_;
  Outbox outbox_;
  std::optional<std::uint64_t> time_ns_;
  bool tells_dropped_ = false;
  std::uint64_t all_dropped_ = 0;  // and told
  int refused_ = 0;
  std::string complaint_;
};

}  // namespace karst::live
