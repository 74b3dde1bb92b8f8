// Bags: recorded messages of ROS 1 (.bag) and ROS 2 (.mcap, .db3), in the order of time. docs/replay.md
#pragma once
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/time.h"
#include "plugins/replay/bag/bytes.h"

namespace karst::replay {

/// How messages are stored: ROS 1 serialization, CDR of ROS 2, or something that karst does not read.
enum class Encoding { ros1, cdr, unknown };

/// Messages of one topic and type. A topic may have several, one for each publisher.
struct Connection {
  std::string topic, type;  // type: "sensor_msgs/PointCloud2", without ROS 2's "msg/"
  Encoding encoding = Encoding::unknown;
  std::string definition;  // the type's definition in .msg text; "" if the bag does not contain it
};

struct BagMessage {
  std::size_t connection = 0;  // index in Bag::connections()
  core::TimeNs time = 0;       // when it was recorded
  Bytes bytes;                 // valid until the next call
  std::size_t chunk_byte = 0;  // byte of the file where its chunk, or itself, begins
  std::size_t byte = 0;        // of the message in its (decompressed) chunk
};

/// Something in a bag that could not be read.
struct Fault {
  std::string place, reason;  // place: "byte 4711, chunk 3"
};

/// The faults of a bag; keeps the first ones, counts all.
class FaultLog {
 public:
  void add(std::string place, std::string reason) {
    if (++count_ <= kKept) faults_.push_back({std::move(place), std::move(reason)});
  }
  /// Each place begins with `prefix`.
  void add(const FaultLog& other, const std::string& prefix = "") {
    for (const Fault& f : other.faults_) add(prefix + f.place, f.reason);
    count_ += other.count_ - other.faults_.size();
  }
  const std::vector<Fault>& first() const { return faults_; }
  std::size_t count() const { return count_; }

 private:
  static constexpr std::size_t kKept = 20;
  std::vector<Fault> faults_;
  std::size_t count_ = 0;
};

constexpr core::TimeNs unknown_begin() { return std::numeric_limits<core::TimeNs>::min(); }

/// Keys of a recording.info with their values.
using RecordedSettings = std::map<std::string, std::string>;
/// Name of the MCAP metadata record in which `karst export` writes them.
constexpr const char* kRecordedSettings = "karst.recording";

class Bag {
 public:
  virtual ~Bag() = default;
  virtual const std::vector<Connection>& connections() const = 0;
  /// Reads only the messages of these connections, one flag each. Before the first `next()`; default: all.
  virtual void select(std::vector<bool> wanted) = 0;
  /// No message was recorded before; `unknown_begin()` if that is not known without reading.
  virtual core::TimeNs begin() const = 0;
  /// The next message in the order of time; nullopt at the end. Leaves out what is damaged, and logs it.
  virtual std::optional<BagMessage> next() = 0;
  /// What could not be read until now.
  virtual const FaultLog& faults() const = 0;
  /// What the file itself says of its recording, beside messages; known from the beginning.
  virtual RecordedSettings recorded_settings() const { return {}; }
};

/// True for .bag, .mcap and .db3, also where they are compressed as files (which open_bag refuses).
bool is_bag(const std::string& path);

/// True for a folder with bags in it, as ROS 2 records them.
bool is_folder_of_bags(const std::string& path);

/// Opens by the file's first bytes; of a folder, all of its bags as one, by the times of their messages. A
/// bag that is cut or has no index is read through once to find its messages. Throws InputError if nothing of
/// it can be read.
std::unique_ptr<Bag> open_bag(const std::string& path);

std::unique_ptr<Bag> open_mcap(const std::string& path);
std::unique_ptr<Bag> open_rosbag1(const std::string& path);
std::unique_ptr<Bag> open_db3(const std::string& path);
std::unique_ptr<Bag> open_bag_folder(const std::string& folder);

/// "sensor_msgs/Imu" of "sensor_msgs/msg/Imu".
std::string plain_type(std::string_view type);

}  // namespace karst::replay
