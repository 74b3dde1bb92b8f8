// The scans and IMU samples of a bag, one after another.
#pragma once
#include <deque>

#include "plugins/replay/recording_guess.h"
#include "plugins/replay/sensor_stream.h"
#include "plugins/replay/stamp_check.h"

namespace karst::replay {

struct BagRecording {
  std::string path, info_file;  // info_file: "" without one
  RecordingInfo info;
  RecordingLayout layout;
  std::vector<std::string> assumptions;  // sentences
};

/// `info_file`, or FILE.info beside FILE.bag, or recording.info in a folder of bags, if that is "" and there
/// is one; keys that it lacks are guessed from the bag's beginning. Throws InputError where that is
/// ambiguous: the reasons tell which keys decide.
BagRecording open_bag_recording(const std::string& path, const std::string& info_file);

/// Reads both topics in one pass. A message that is damaged is left out and logged.
class BagSensors final : public SensorStream {
 public:
  explicit BagSensors(BagRecording recording);

  core::TimeNs begin() const override { return begin_; }
  std::optional<std::size_t> scans() const override { return std::nullopt; }
  std::optional<core::Sweep> next_sweep(ReadNotes& notes) override;
  bool has_imu() const override { return recording_.info.imu_topic != "none"; }
  std::optional<core::ImuSample> next_imu() override;
  Damage damage() const override;
  std::size_t scans_without_returns() const override { return without_returns_; }

 private:
  struct MessagePlace {
    std::size_t connection = 0, chunk_byte = 0, byte = 0;
  };
  struct QueuedCloud {
    CloudMessage cloud;
    MessagePlace place;
    core::TimeNs shift = 0;  // of its stamp, and of times that are absolute
  };
  struct QueuedSample {
    core::ImuSample sample;
    MessagePlace place;
  };

  bool read_one();  // false at the end of the bag
  void take_cloud(const BagMessage& m);
  void take_imu(const BagMessage& m);
  void queue(StampCheck<QueuedCloud>::Verdict clouds);
  void queue(StampCheck<QueuedSample>::Verdict samples);
  void queue(core::ImuSample sample, const MessagePlace& place);
  template <class Verdict>
  void log(const Verdict& verdict);
  std::string text_of(const MessagePlace& place) const;
  std::optional<core::Sweep> make_sweep(ReadNotes& notes);

  BagRecording recording_;
  std::unique_ptr<Bag> bag_;
  MessageDecoder decoder_;
  std::deque<QueuedCloud> clouds_;
  std::deque<core::ImuSample> imu_;
  StampCheck<QueuedCloud> cloud_stamps_;
  StampCheck<QueuedSample> imu_stamps_;
  std::optional<core::TimeNs> last_sweep_, last_imu_;
  std::optional<std::pair<core::Sweep, ReadNotes>> first_;
  core::TimeNs begin_ = 0;
  std::size_t without_returns_ = 0;
  FaultLog faults_;  // of messages; the bag has its own
};

struct WrittenTruth {
  std::size_t poses = 0, damaged = 0;
};
/// Writes the poses of a bag's topic in the TUM format. For the evaluation only. Throws InputError if there
/// is none.
WrittenTruth write_truth(const std::string& bag, const std::string& topic, const std::string& tum_file);

}  // namespace karst::replay
