// A folder of bags that a recorder began one after another, as ROS 2 does when it splits them.
#include <algorithm>
#include <filesystem>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/bag.h"

namespace karst::replay {
namespace {

namespace fs = std::filesystem;

class BagSequence final : public Bag {
 public:
  explicit BagSequence(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
      Part part{fs::path(path).filename().string(), open_bag(path), {}};
      for (const Connection& c : part.bag->connections()) part.number.push_back(number_of(c));
      parts_.push_back(std::move(part));
    }
  }

  const std::vector<Connection>& connections() const override { return connections_; }
  const FaultLog& faults() const override { return faults_; }

  void select(std::vector<bool> wanted) override {
    for (Part& part : parts_) {
      std::vector<bool> of_part;
      for (const std::size_t n : part.number) of_part.push_back(n < wanted.size() && wanted[n]);
      part.bag->select(std::move(of_part));
    }
  }

  std::optional<BagMessage> next() override {
    for (; at_ < parts_.size(); ++at_) {
      Part& part = parts_[at_];
      if (auto m = part.bag->next()) {
        m->connection = part.number.at(m->connection);
        return m;
      }
      for (const Fault& f : part.bag->faults().first()) faults_.add(part.name + ", " + f.place, f.reason);
      part.bag.reset();
    }
    return std::nullopt;
  }

 private:
  struct Part {
    std::string name;
    std::unique_ptr<Bag> bag;         // none after its end
    std::vector<std::size_t> number;  // of each of its connections, in the sequence
  };

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
  std::size_t at_ = 0;
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
  return std::make_unique<BagSequence>(paths);
}

}  // namespace karst::replay
