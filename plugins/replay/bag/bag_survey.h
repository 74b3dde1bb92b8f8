// What a bag contains: its topics with rates and gaps, and samples of what LiDARs, IMUs and frames say.
#pragma once
#include <string>
#include <vector>

#include "plugins/replay/bag/sensor_messages.h"

namespace karst::replay {

struct TopicFacts {
  std::string topic, type;
  Encoding encoding = Encoding::unknown;
  std::size_t messages = 0;
  std::uint64_t bytes = 0;
  core::TimeNs first = 0, last = 0;             // times of recording
  core::TimeNs longest_gap = 0, gap_after = 0;  // between two messages, and the time of the first of them
  double rate_hz() const {
    return messages > 1 && last > first ? static_cast<double>(messages - 1) / core::seconds(last - first) : 0;
  }
};

/// Of one scan that was looked at. Times in the field's own unit.
struct CloudSample {
  core::TimeNs stamp = 0;
  std::size_t declared = 0, returns = 0;  // returns: finite and not at the origin
  double first_time = 0, last_time = 0;   // least and greatest of the returns
  int rings = 0;                          // greatest ring and one
};
struct CloudFacts {
  std::string topic, type, frame;
  std::vector<CloudField> fields;
  std::vector<CloudSample> samples;
  std::string problem;  // why a scan could not be decoded; "" if all could
};

struct ImuFacts {
  std::string topic, frame;
  std::size_t samples = 0;
  double mean_force = 0;  // of the norms, in the topic's own unit
  std::string problem;
};

struct BagSurvey {
  std::vector<TopicFacts> topics;  // in the order in which the bag names them
  std::vector<CloudFacts> clouds;
  std::vector<ImuFacts> imus;
  std::vector<FrameTransform> transforms;  // of /tf_static
  core::TimeNs first = 0, last = 0;
  bool whole = false;  // read to the end
  RecordedSettings settings;
  FaultLog faults;
};

enum class SurveyExtent { beginning, all };

/// Reads the bag to its end, or until its first seconds tell enough for a replay. Throws InputError.
BagSurvey survey_bag(const std::string& path, SurveyExtent extent, const FieldNames& names = {});

}  // namespace karst::replay
