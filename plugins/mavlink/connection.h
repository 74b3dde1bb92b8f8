// Messages to and from one autopilot over a link of bytes. What other systems say on it is not heard.
#pragma once
#include <map>
#include <memory>

#include "plugins/mavlink/link/byte_link.h"
#include "plugins/mavlink/wire/frame.h"

namespace karst::mavlink {

constexpr std::uint8_t kAutopilotComponent = 1, kOnboardComputer = 191;

inline Address autopilot_of(std::int64_t system) {
  return {static_cast<std::uint8_t>(system), kAutopilotComponent};
}

/// Of one kind of message.
struct Traffic {
  std::uint64_t messages = 0, bytes = 0;
};
using TrafficById = std::map<std::uint32_t, Traffic>;

class Connection {
 public:
  Connection(std::unique_ptr<ByteLink> link, Address own, Address peer)
      : link_(std::move(link)), own_(own), peer_(peer) {}

  template <class Message>
  void send(const Message& m) {
    send_frame(frame_of(m, own_));
  }
  /// As another system that shares the link would.
  template <class Message>
  void send_as(Address from, const Message& m) {
    link_->send(to_wire(frame_of(m, from)));
  }
  /// Reads what has come; then `next` gives it frame by frame.
  void receive();
  std::optional<Frame> next();

  Address own() const { return own_; }
  Address peer() const { return peer_; }
  const TrafficById& sent() const { return sent_; }
  const TrafficById& received() const { return received_; }
  const LossCount& loss() const { return loss_; }
  std::uint64_t from_others() const { return from_others_; }
  const FrameParser::Counts& parsed() const { return parser_.counts(); }

 private:
  void send_frame(Frame frame);

  std::unique_ptr<ByteLink> link_;
  Address own_, peer_;
  std::uint8_t sequence_ = 0;
  FrameParser parser_;
  LossCount loss_;
  TrafficById sent_, received_;
  std::uint64_t from_others_ = 0;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace karst::mavlink
