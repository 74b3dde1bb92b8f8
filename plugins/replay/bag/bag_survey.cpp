#include "plugins/replay/bag/bag_survey.h"

#include <algorithm>
#include <cmath>

namespace karst::replay {
namespace {

constexpr std::size_t kCloudSamples = 10, kImuSamples = 200;
constexpr core::TimeNs kBeginning = 5 * core::kSecond, kPatience = 30 * core::kSecond;

CloudSample sample_of(const CloudMessage& cloud) {
  CloudSample s{cloud.stamp, cloud.declared, 0, 0, 0, 0};
  for (const ScanPoint& p : cloud.scan.points) {
    s.rings = std::max(s.rings, p.ring + 1);
    if (p.position.isZero()) continue;  // no return
    s.first_time = s.returns == 0 ? p.time : std::min(s.first_time, p.time);
    s.last_time = s.returns == 0 ? p.time : std::max(s.last_time, p.time);
    ++s.returns;
  }
  return s;
}

/// What is known of one topic; topics are few.
template <class Facts>
Facts& of_topic(std::vector<Facts>& all, const std::string& topic) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Facts& f) { return f.topic == topic; });
  if (found != all.end()) return *found;
  all.emplace_back().topic = topic;
  return all.back();
}

class Surveyor {
 public:
  Surveyor(const std::vector<Connection>& connections, const FieldNames& names)
      : connections_(connections), decoder_(connections), names_(names) {
    for (const Connection& c : connections) {
      TopicFacts& t = of_topic(survey.topics, c.topic);
      t.type = c.type;
      t.encoding = c.encoding;
      if (is_cloud_type(c.type)) of_topic(survey.clouds, c.topic).type = c.type;
      if (c.type == "sensor_msgs/Imu") of_topic(survey.imus, c.topic);
    }
  }

  void take(const BagMessage& m) {
    const Connection& c = connections_[m.connection];
    TopicFacts& t = of_topic(survey.topics, c.topic);
    if (t.messages == 0) t.first = m.time;
    if (t.messages > 0 && m.time - t.last > t.longest_gap) {
      t.longest_gap = m.time - t.last;
      t.gap_after = t.last;
    }
    t.last = m.time;
    ++t.messages;
    t.bytes += m.bytes.size();
    if (!begun_) survey.first = m.time;
    begun_ = true;
    survey.last = m.time;
    if (is_cloud_type(c.type)) take_cloud(of_topic(survey.clouds, c.topic), m);
    if (c.type == "sensor_msgs/Imu") take_imu(of_topic(survey.imus, c.topic), m);
    if (c.topic.ends_with("tf_static") && survey.transforms.size() < 1000) take_transforms(m);
  }

  /// Not every topic of clouds has many: a map may be a cloud, too.
  bool tells_enough() const {
    const core::TimeNs span = survey.last - survey.first;
    const auto sampled = [](std::size_t count) {
      return [count](const CloudFacts& c) { return c.samples.size() >= count; };
    };
    const auto& clouds = survey.clouds;
    return (span > kBeginning && std::all_of(clouds.begin(), clouds.end(), sampled(kCloudSamples))) ||
           (span > kPatience && std::any_of(clouds.begin(), clouds.end(), sampled(kCloudSamples)));
  }

  BagSurvey survey;

 private:
  void take_cloud(CloudFacts& facts, const BagMessage& m) {
    if (facts.samples.size() == kCloudSamples) return;
    try {
      const Message message = decoder_.decode(m.connection, m.bytes);
      if (facts.fields.empty()) facts.fields = cloud_fields(facts.type, message, names_);
      const CloudMessage cloud = cloud_of(facts.type, message, names_);
      facts.frame = cloud.frame;
      const CloudSample sample = sample_of(cloud);
      if (sample.returns > 0)
        facts.samples.push_back(sample);
      else if (facts.problem.empty())
        facts.problem = "they have no returns";
    } catch (const MalformedError& e) {
      facts.problem = e.what();
    }
  }

  void take_imu(ImuFacts& facts, const BagMessage& m) {
    if (facts.samples == kImuSamples) return;
    try {
      const Message message = decoder_.decode(m.connection, m.bytes);
      const double force = imu_of(message).specific_force_mps2.norm();
      facts.frame = frame_of(message);
      ++facts.samples;
      facts.mean_force += (force - facts.mean_force) / static_cast<double>(facts.samples);
    } catch (const MalformedError& e) {
      facts.problem = e.what();
    }
  }

  void take_transforms(const BagMessage& m) {
    try {
      for (FrameTransform& t : transforms_of(decoder_.decode(m.connection, m.bytes))) {
        // A frame has one parent: what is said later replaces what was said before.
        std::erase_if(survey.transforms, [&](const FrameTransform& known) { return known.child == t.child; });
        survey.transforms.push_back(std::move(t));
      }
    } catch (const MalformedError& e) {
      survey.faults.add("topic " + connections_[m.connection].topic, e.what());
    }
  }

  const std::vector<Connection>& connections_;
  MessageDecoder decoder_;
  FieldNames names_;
  bool begun_ = false;
};

}  // namespace

BagSurvey survey_bag(const std::string& path, SurveyExtent extent, const FieldNames& names) {
  const auto bag = open_bag(path);
  Surveyor surveyor(bag->connections(), names);
  bool ended = false;
  while (!ended && (extent == SurveyExtent::all || !surveyor.tells_enough())) {
    const auto message = bag->next();
    ended = !message;
    if (message) surveyor.take(*message);
  }
  BagSurvey survey = std::move(surveyor.survey);
  survey.whole = ended;
  survey.settings = bag->recorded_settings();
  survey.faults.add(bag->faults());
  return survey;
}

}  // namespace karst::replay
