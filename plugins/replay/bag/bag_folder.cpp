// A folder of bags as one: ROS 2 splits a long recording into bags that follow each other, and bags recorded
// side by side overlap.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/bag.h"

namespace karst::replay {
namespace {

namespace fs = std::filesystem;

class BagFolder final : public Bag {
 public:
  explicit BagFolder(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
      Part part;
      part.name = fs::path(path).filename().string();
      part.bag = open_bag(path);
      part.begin = part.bag->begin();
      if (settings_.empty()) settings_ = part.bag->recorded_settings();
      number_connections(part);
      parts_.push_back(std::move(part));
    }
  }

  const std::vector<Connection>& connections() const override { return connections_; }
  const FaultLog& faults() const override { return faults_; }
  RecordedSettings recorded_settings() const override { return settings_; }

  void select(std::vector<bool> wanted) override {
    for (Part& part : parts_) {
      std::vector<bool> of_part;
      for (const std::size_t n : part.number) of_part.push_back(n < wanted.size() && wanted[n]);
      part.bag->select(std::move(of_part));
    }
  }

  core::TimeNs begin() const override {
    core::TimeNs earliest = std::numeric_limits<core::TimeNs>::max();
    for (const Part& part : parts_) earliest = std::min(earliest, part.begin);
    return earliest;
  }

  std::optional<BagMessage> next() override {
    if (taken_) advance(parts_[*std::exchange(taken_, std::nullopt)]);
    begin_what_may_come_first();
    const Part* first = first_part();
    if (!first) return std::nullopt;
    taken_ = static_cast<std::size_t>(first - parts_.data());
    return first->head;
  }

 private:
  struct Part {
    std::string name;
    std::unique_ptr<Bag> bag;         // none after its end
    std::vector<std::size_t> number;  // of each of its connections, in the folder
    core::TimeNs begin = 0;
    bool begun = false;
    std::optional<BagMessage> head;  // its next message
  };

  /// The part with the earliest next message.
  const Part* first_part() const {
    const Part* first = nullptr;
    for (const Part& part : parts_)
      if (part.head && (!first || part.head->time < first->head->time)) first = &part;
    return first;
  }

  /// Of parts that were recorded one after another, only one has messages in memory.
  void begin_what_may_come_first() {
    for (;;) {
      Part* next = nullptr;
      for (Part& part : parts_)
        if (!part.begun && (!next || part.begin < next->begin)) next = &part;
      const Part* first = first_part();
      if (!next || (first && first->head->time < next->begin)) return;
      next->begun = true;
      advance(*next);
    }
  }

  void advance(Part& part) {
    part.head = part.bag->next();
    if (part.head) {
      number_connections(part);
      part.head->connection = part.number.at(part.head->connection);
    } else {
      faults_.add(part.bag->faults(), part.name + ", ");
      part.bag.reset();
    }
  }

  /// While it is read, a bag may find connections that its summary does not list.
  void number_connections(Part& part) {
    const std::vector<Connection>& all = part.bag->connections();
    while (part.number.size() < all.size()) part.number.push_back(number_of(all[part.number.size()]));
  }

  std::size_t number_of(const Connection& c) {
    const auto same = std::find_if(connections_.begin(), connections_.end(), [&](const Connection& other) {
      return other.topic == c.topic && other.type == c.type && other.encoding == c.encoding &&
             other.definition == c.definition;
    });
    if (same != connections_.end()) return static_cast<std::size_t>(same - connections_.begin());
    connections_.push_back(c);
    return connections_.size() - 1;
  }

  std::vector<Part> parts_;
  std::vector<Connection> connections_;
  RecordedSettings settings_;         // of the first part that has any
  std::optional<std::size_t> taken_;  // part of the last message
  FaultLog faults_;
};

/// The bags of a folder, by the numbers at the end of their names: flight_2 before flight_10.
std::vector<std::string> bags_in(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file() && is_bag(entry.path().string())) paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return paths;
}

}  // namespace

bool is_folder_of_bags(const std::string& path) { return fs::is_directory(path) && !bags_in(path).empty(); }

std::unique_ptr<Bag> open_bag_folder(const std::string& folder) {
  const std::vector<std::string> paths = bags_in(folder);
  if (paths.empty()) throw core::InputError(folder, "", "holds no bag: no .bag, .mcap or .db3");
  return std::make_unique<BagFolder>(paths);
}

}  // namespace karst::replay
