#include "sdk/live/outbox.h"

#include <algorithm>

namespace karst::live {

void Outbox::put(const LiveMessage& message, Keeping keeping) {
  const std::size_t size = message.bytes->size();
  Queue& queue = queues_[message.topic];
  if (keeping == Keeping::whole)
    while (!queue.waiting.empty()) pop(queue);
  while (!queue.waiting.empty() && (bytes_ + size > kMaxBytes || queue.waiting.size() >= kMaxMessages))
    drop_oldest(message.topic);
  while (messages_ > 0 && bytes_ + size > kMaxBytes) drop_oldest(fullest());
  queue.waiting.push_back({next_number_++, message});
  queue.bytes += size;
  bytes_ += size;
  ++messages_;
}

std::optional<LiveMessage> Outbox::take() {
  Queue* oldest = nullptr;
  for (auto& [topic, queue] : queues_)
    if (!queue.waiting.empty() && (!oldest || queue.waiting.front().number < oldest->waiting.front().number))
      oldest = &queue;
  if (!oldest) return std::nullopt;
  LiveMessage message = oldest->waiting.front().message;
  pop(*oldest);
  return message;
}

void Outbox::forget(std::size_t topic) {
  Queue& queue = queues_[topic];
  while (!queue.waiting.empty()) pop(queue);
}

void Outbox::pop(Queue& queue) {
  const std::size_t size = queue.waiting.front().message.bytes->size();
  queue.bytes -= size;
  bytes_ -= size;
  --messages_;
  queue.waiting.pop_front();
}

void Outbox::drop_oldest(std::size_t topic) {
  ++dropped_[topic];
  pop(queues_[topic]);
}

std::size_t Outbox::fullest() const {
  return std::max_element(queues_.begin(), queues_.end(),
                          [](const auto& a, const auto& b) { return a.second.bytes < b.second.bytes; })
      ->first;
}

}  // namespace karst::live
