#include "plugins/simulated_autopilot/simulated_link.h"

#include <algorithm>

namespace karst::sim {

using core::TimeNs;

void describe(core::OptionTable& t, SimulatedLinkOptions& o) {
  t.add("latency", o.latency_s, "s", 0, 2, "of the link, one way");
  t.add("jitter", o.jitter_s, "s", 0, 1, "added to the latency: anything from 0 to this");
  t.add("loss", o.loss, "", 0, 1, "fraction of the messages that are lost");
  t.add("garbage", o.garbage, "", 0, 1, "fraction of the messages that come behind noise");
  t.add("corruption", o.corruption, "", 0, 1, "fraction of the messages of which a byte is wrong");
  t.add("link_lost_at", o.lost_from_s, "s", 0, 86400, "when the link is lost, both ways");
  t.add("link_lost_for", o.lost_for_s, "s", 0, 86400, "for how long; 0: never");
}

struct SimulatedLink::Line {
  struct Message {
    TimeNs arrives;
    std::vector<std::uint8_t> bytes;
  };
  struct Way {  // to one of the ends
    std::deque<Message> under_way;
    core::Random random;
    TimeNs last = 0;
  };

  SimulatedLinkOptions options;
  std::function<TimeNs()> now;
  std::array<Way, 2> ways;
  TimeNs lost_until = 0;

  bool lost() const {
    const double t = core::seconds(now());
    return now() < lost_until || (t >= options.lost_from_s && t < options.lost_from_s + options.lost_for_s);
  }
};

class SimulatedLink::Port final : public mavlink::ByteLink {
 public:
  Port(std::shared_ptr<Line> line, End end) : line_(std::move(line)), end_(static_cast<std::size_t>(end)) {}

  void send(std::span<const std::uint8_t> bytes) override {
    const SimulatedLinkOptions& o = line_->options;
    Line::Way& way = line_->ways[1 - end_];
    const bool lost = way.random.uniform() < o.loss;
    const double delay_s = o.latency_s + o.jitter_s * way.random.uniform();
    std::vector<std::uint8_t> sent;
    if (way.random.uniform() < o.garbage)
      for (auto left = way.random.bits() % 40; left > 0; --left)
        sent.push_back(static_cast<std::uint8_t>(way.random.bits()));
    const std::size_t begin = sent.size();
    sent.insert(sent.end(), bytes.begin(), bytes.end());
    if (way.random.uniform() < o.corruption && !bytes.empty())
      sent[begin + way.random.bits() % bytes.size()] ^= 0x55;
    if (lost || line_->lost()) return;
    way.last = std::max(way.last, line_->now() + core::from_seconds(delay_s));
    way.under_way.push_back({way.last, std::move(sent)});
  }
  void receive(std::vector<std::uint8_t>& into) override {
    std::deque<Line::Message>& waiting = line_->ways[end_].under_way;
    if (line_->lost()) waiting.clear();
    for (; !waiting.empty() && waiting.front().arrives <= line_->now(); waiting.pop_front())
      into.insert(into.end(), waiting.front().bytes.begin(), waiting.front().bytes.end());
  }

 private:
  std::shared_ptr<Line> line_;
  std::size_t end_;
};

SimulatedLink::SimulatedLink(const SimulatedLinkOptions& options, std::uint64_t seed,
                             std::function<TimeNs()> now)
    : line_(new Line{options,
                     std::move(now),
                     {Line::Way{{}, core::Random::stream(seed, "link to the core")},
                      Line::Way{{}, core::Random::stream(seed, "link to the autopilot")}}}) {}

std::unique_ptr<mavlink::ByteLink> SimulatedLink::open(End end) { return std::make_unique<Port>(line_, end); }

void SimulatedLink::lose_until(TimeNs until) { line_->lost_until = until; }

}  // namespace karst::sim
