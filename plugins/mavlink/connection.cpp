#include "plugins/mavlink/connection.h"

namespace karst::mavlink {
namespace {

constexpr std::size_t kFraming = 12;

}  // namespace

void Connection::receive() {
  buffer_.clear();
  link_->receive(buffer_);
  parser_.add(buffer_);
}

std::optional<Frame> Connection::next() {
  for (;;) {
    std::optional<Frame> frame = parser_.next();
    if (!frame) return std::nullopt;
    if (frame->from != peer_) {
      ++from_others_;
      continue;
    }
    loss_.note(*frame);
    Traffic& traffic = received_[frame->id];
    ++traffic.messages;
    traffic.bytes += kFraming + frame->size;
    return frame;
  }
}

void Connection::send_frame(Frame frame) {
  frame.sequence = sequence_++;
  const std::vector<std::uint8_t> bytes = to_wire(frame);
  Traffic& traffic = sent_[frame.id];
  ++traffic.messages;
  traffic.bytes += bytes.size();
  link_->send(bytes);
}

}  // namespace karst::mavlink
