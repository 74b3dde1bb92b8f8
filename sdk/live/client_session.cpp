#include "sdk/live/client_session.h"

#include <algorithm>
#include <utility>

namespace karst::live {

ClientSession::ClientSession(const Retained& retained, std::string server_info) : retained_(retained) {
  text(std::move(server_info));
  text(advertisement(retained.topics()));
}

void ClientSession::receive(std::string_view request) {
  std::visit([this](const auto& r) { take(r); }, request_of(request));
}

void ClientSession::take(const Subscribe& request) {
  for (const Subscribe::One& one : request.all) {
    const bool taken = std::any_of(subscriptions_.begin(), subscriptions_.end(),
                                   [&](const auto& s) { return s.second == one.id; });
    if (one.channel >= retained_.topics().size()) {
      refuse("there is no channel " + std::to_string(one.channel));
    } else if (taken) {
      refuse("the subscription " + std::to_string(one.id) + " exists already");
    } else if (!subscriptions_.emplace(one.channel, one.id).second) {
      refuse("you have subscribed to " + retained_.topics()[one.channel].name + " already");
    } else {
      for (const LiveMessage& m : retained_.of(one.channel))
        outbox_.put(m, retained_.topics()[one.channel].keeping);
    }
  }
}

void ClientSession::take(const Unsubscribe& request) {
  for (const std::uint32_t id : request.ids) {
    const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                    [id](const auto& s) { return s.second == id; });
    if (found == subscriptions_.end()) {
      refuse("there is no subscription " + std::to_string(id));
      continue;
    }
    outbox_.forget(found->first);
    subscriptions_.erase(found);
  }
}

void ClientSession::refuse(const std::string& why) {
  if (++refused_ > kMaxRefused)
    complaint_ =
        "more than " + std::to_string(kMaxRefused) + " requests that make no sense; the last: " + why;
  else
    tell(StatusLevel::error, why);
}

void ClientSession::tell(StatusLevel level, const std::string& words, const std::string& id) {
  text(status(level, words, id));
}

void ClientSession::text(std::string bytes) {
  if (texts_.size() < kMaxTexts)
    texts_.push_back(std::move(bytes));
  else
    complaint_ = "it does not read what it asks for";
}

void ClientSession::publish(const LiveMessage& message) {
  if (subscriptions_.contains(message.topic)) outbox_.put(message, retained_.topics()[message.topic].keeping);
}

std::uint64_t ClientSession::dropped() const {
  std::uint64_t all = all_dropped_;
  for (const auto& [topic, count] : outbox_.dropped()) all += count;
  return all;
}

std::optional<std::string> ClientSession::dropped_text() {
  if (!std::exchange(tells_dropped_, false)) return std::nullopt;
  std::string list;
  for (const auto& [topic, count] : outbox_.take_dropped()) {
    list += (list.empty() ? "" : ", ") + std::to_string(count) + " of " + retained_.topics()[topic].name;
    all_dropped_ += count;
  }
  if (list.empty()) return std::nullopt;
  return status(StatusLevel::warning, "you read too slowly; dropped: " + list, "dropped");
}

std::optional<Frame> ClientSession::next() {
  const auto whole = [](std::string bytes, bool binary) {
    return Frame{binary, std::nullopt, std::make_shared<const std::string>(std::move(bytes))};
  };
  if (!texts_.empty()) {
    Frame frame = whole(std::move(texts_.front()), false);
    texts_.pop_front();
    return frame;
  }
  if (auto dropped = dropped_text()) return whole(std::move(*dropped), false);
  if (const auto time_ns = std::exchange(time_ns_, std::nullopt)) return whole(time_frame(*time_ns), true);
  const std::optional<LiveMessage> m = outbox_.take();
  if (!m) return std::nullopt;
  return Frame{true, message_head(subscriptions_.at(m->topic), m->time_ns), m->bytes};
}

}  // namespace karst::live
