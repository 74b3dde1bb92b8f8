// The last messages of a flight, for who subscribes later.
#pragma once
#include <vector>

#include "sdk/live/live_topic.h"

namespace karst::live {

class Retained {
 public:
  /// `map`: the topic to which those with Keeping::since_latest_map refer.
  Retained(std::vector<LiveTopic> topics, std::size_t map) : topics_(std::move(topics)), map_(map) {
    messages_.resize(topics_.size());
  }

  void keep(const LiveMessage& message) {
    std::vector<LiveMessage>& kept = messages_[message.topic];
    const Keeping keeping = topics_[message.topic].keeping;
    if (message.topic == map_)
      for (std::size_t i = 0; i < topics_.size(); ++i)
        if (topics_[i].keeping == Keeping::since_latest_map) messages_[i].clear();
    if (keeping == Keeping::none) return;
    if (keeping != Keeping::since_latest_map) kept.clear();
    kept.push_back(message);
  }

  /// In the order of their coming.
  const std::vector<LiveMessage>& of(std::size_t topic) const { return messages_[topic]; }
  const std::vector<LiveTopic>& topics() const { return topics_; }

 private:
  std::vector<LiveTopic> topics_;
  std::size_t map_;
  std::vector<std::vector<LiveMessage>> messages_;  // of each topic
};

}  // namespace karst::live
