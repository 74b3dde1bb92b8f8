#include "plugins/mavlink/command_queue.h"

#include <algorithm>
#include <utility>

namespace karst::mavlink {
namespace {

constexpr core::TimeNs kPatience = 400 * core::kMillisecond;
constexpr int kRepetitions = 5;

}  // namespace

const char* text_of(CmdResult r) {
  switch (r) {
    case CmdResult::accepted:
      return "accepted";
    case CmdResult::temporarily_rejected:
      return "temporarily rejected";
    case CmdResult::denied:
      return "denied";
    case CmdResult::unsupported:
      return "unsupported";
    case CmdResult::failed:
      return "failed";
    case CmdResult::in_progress:
      return "in progress";
    case CmdResult::cancelled:
      return "cancelled";
    case CmdResult::no_answer:
      return "no answer";
  }
  return "unknown result";
}

void CommandQueue::add(const CommandLong& command, Done done) {
  queue_.push_back({command, std::move(done)});
}

bool CommandQueue::waits_for(Cmd command) const {
  return std::any_of(queue_.begin(), queue_.end(), [command](const Waiting& w) {
    return w.command.command == static_cast<std::uint16_t>(command);
  });
}

std::optional<CommandLong> CommandQueue::due(core::TimeNs now) {
  if (queue_.empty()) return std::nullopt;
  Waiting& first = queue_.front();
  if (first.sent > 0 && now - first.sent_at < kPatience) return std::nullopt;
  if (first.sent == kRepetitions) {
    finish(CmdResult::no_answer);
    return due(now);
  }
  CommandLong command = first.command;
  command.confirmation = static_cast<std::uint8_t>(first.sent++);
  first.sent_at = now;
  return command;
}

void CommandQueue::on_ack(const CommandAck& ack) {
  if (queue_.empty() || queue_.front().sent == 0 || queue_.front().command.command != ack.command) return;
  if (ack.result == static_cast<std::uint8_t>(CmdResult::in_progress)) return;
  finish(static_cast<CmdResult>(ack.result));
}

void CommandQueue::finish(CmdResult result) {
  const Done done = std::move(queue_.front().done);
  queue_.pop_front();
  if (done) done(result);
}

}  // namespace karst::mavlink
