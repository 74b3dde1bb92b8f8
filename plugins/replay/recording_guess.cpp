#include "plugins/replay/recording_guess.h"

#include <algorithm>
#include <array>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core_stack/common/error.h"
#include "core_stack/common/euler_angles.h"
#include "core_stack/common/printable.h"
#include "plugins/replay/scan_files/decimal_time.h"

namespace karst::replay {
namespace {

using core::TimeNs;

bool has_field(const CloudFacts& c, std::string_view name, std::optional<ValueType> type = std::nullopt) {
  return std::any_of(c.fields.begin(), c.fields.end(),
                     [&](const CloudField& f) { return f.name == name && (!type || f.type == *type); });
}

const CloudField* field_with(const CloudFacts& c, Role role) {
  const auto found =
      std::find_if(c.fields.begin(), c.fields.end(), [&](const CloudField& f) { return f.role == role; });
  return found == c.fields.end() ? nullptr : &*found;
}

struct Kind {
  std::string name, evidence;
};
/// By the fields that each driver declares.
Kind kind_of(const CloudFacts& c) {
  if (c.type.ends_with("/CustomMsg")) return {"Livox", "its type is " + c.type};
  if (has_field(c, "tag") && has_field(c, "line")) return {"Livox", "its points have tag and line"};
  if (has_field(c, "t", ValueType::uint32) && (has_field(c, "reflectivity") || has_field(c, "range")))
    return {"Ouster", "its points have t (uint32), and reflectivity or range"};
  if (has_field(c, "ring") && has_field(c, "timestamp", ValueType::float64))
    return {"Hesai or RoboSense", "its points have ring and timestamp (float64)"};
  if (has_field(c, "ring") && has_field(c, "time", ValueType::float32))
    return {"Velodyne", "its points have ring and time (float32)"};
  if (has_field(c, "t", ValueType::uint32) && has_field(c, "intensity"))
    return {"karst", "its points have intensity and t (uint32), as karst exports them"};
  return {"unknown", "its fields are those of no driver that karst knows"};
}

/// Three numbers with the digits that count, such as "0 0 0.5".
std::string three(const core::Vec3& v) {
  const auto rounded = [](double x) { return std::round(x * 1e9) * 1e-9 + 0.0; };
  std::array<char, 120> text;
  std::snprintf(text.data(), text.size(), "%.9g %.9g %.9g", rounded(v.x()), rounded(v.y()), rounded(v.z()));
  return text.data();
}

std::string degrees_of(const core::Quat& q) {
  return three(core::euler_angles_of(q) * (180 / std::numbers::pi));
}

std::string namespace_of(const std::string& topic) { return topic.substr(0, topic.find('/', 1)); }

class Guesser {
 public:
  Guesser(const BagSurvey& survey, const RecordingInfo& given, const std::set<std::string>& keys)
      : survey_(survey), keys_(keys) {
    guess.info = given;
  }

  void work() {
    const CloudFacts* lidar = choose_lidar();
    if (!lidar) return;
    guess.info.lidar_topic = lidar->topic;
    const Kind kind = kind_of(*lidar);
    guess.lidar = kind.name;
    ground("The LiDAR is " + lidar->topic + ", of kind " + kind.name + ": " + kind.evidence + ".");
    guess_period(*lidar);
    guess_times(*lidar);
    guess_rings(*lidar, kind);
    const ImuFacts* imu = choose_imu(*lidar);
    const bool named = guess.info.imu_topic != "auto";
    guess.info.imu_topic = "none";
    if (imu) guess_force_unit(*imu);
    guess_mounting(*lidar, imu, named);
  }

  RecordingGuess guess;

 private:
  void ground(std::string sentence) { guess.grounds.push_back(std::move(sentence)); }
  void doubt(std::string sentence) { guess.doubts.push_back(std::move(sentence)); }

  const CloudFacts* choose_lidar() {
    const std::string& wanted = guess.info.lidar_topic;
    std::vector<const CloudFacts*> candidates;
    for (const CloudFacts& c : survey_.clouds)
      if (wanted == "auto" ? !c.samples.empty() : c.topic == wanted) candidates.push_back(&c);
    if (candidates.size() > 1) {
      // Clouds that were worked out, such as a map, have no times.
      std::vector<const CloudFacts*> measured;
      for (const CloudFacts* c : candidates)
        if (field_with(*c, Role::time)) measured.push_back(c);
      if (measured.size() == 1) {
        ground("Of several topics with clouds, " + measured.front()->topic +
               " is the only one whose points have times.");
        candidates = measured;
      }
    }
    if (candidates.size() > 1) {
      std::string names;
      for (const CloudFacts* c : candidates) names += (names.empty() ? "" : ", ") + c->topic;
      doubt("Several topics have scans: " + names + ". Choose one with bag.lidar.");
      return nullptr;
    }
    if (candidates.empty()) {
      std::string problem;
      for (const CloudFacts& c : survey_.clouds)
        if (!c.problem.empty()) problem = " (" + c.topic + ": " + c.problem + ")";
      doubt((wanted == "auto" ? "No topic has scans: sensor_msgs/PointCloud2 or Livox' CustomMsg"
                              : "The topic " + wanted + " of bag.lidar has no scans") +
            problem + ".");
      return nullptr;
    }
    if (candidates.front()->samples.empty()) {
      doubt("The scans of " + candidates.front()->topic +
            " cannot be decoded: " + candidates.front()->problem + ".");
      return nullptr;
    }
    return candidates.front();
  }

  void guess_period(const CloudFacts& lidar) {
    std::vector<TimeNs> steps;
    for (std::size_t i = 1; i < lidar.samples.size(); ++i)
      steps.push_back(lidar.samples[i].stamp - lidar.samples[i - 1].stamp);
    if (steps.empty()) return;
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    const double median_s = core::seconds(steps[steps.size() / 2]);
    if (median_s < 0.001 || median_s > 10) return;
    guess.info.period_s = std::round(median_s * 1000) / 1000;
  }

  void guess_times(const CloudFacts& lidar) {
    const CloudField* field = field_with(lidar, Role::time);
    if (!field) return ground("The points have no times: motion during a scan is not compensated.");
    const bool by_hand = given("time.unit") && guess.info.time_unit != "auto";
    const CloudSample* widest = &lidar.samples.front();
    for (const CloudSample& s : lidar.samples)
      if (s.last_time - s.first_time > widest->last_time - widest->first_time) widest = &s;
    const double spread = widest->last_time - widest->first_time;
    if (spread == 0)
      return ground("The times of all points are equal: motion during a scan is not compensated.");
    // A sweep lasts between 2 ms and 1 s: one unit fits at most.
    std::string unit;
    for (const char* u : {"s", "ms", "us", "ns"}) {
      const double length_s = spread * static_cast<double>(nanoseconds_of(u)) * 1e-9;
      if (length_s >= 0.002 && length_s <= 1.0) unit = u;
    }
    if (by_hand) unit = guess.info.time_unit;
    if (unit.empty())
      return doubt("The times of a scan's points (" + field->name + ") spread over " +
                   std::to_string(spread) +
                   ", which is a sweep in no unit: say what they are with time.unit and time.of.");
    guess.info.time_unit = unit;
    const double unit_s = static_cast<double>(nanoseconds_of(unit)) * 1e-9;
    std::array<char, 200> text;
    std::snprintf(text.data(), text.size(),
                  "The times of the points (%s) are in %s: a scan's spread over %.1f ms.",
                  field->name.c_str(), unit.c_str(), 1e3 * spread * unit_s);
    ground(text.data());
    guess_origin(lidar, unit_s);
  }

  void guess_origin(const CloudFacts& lidar, double unit_s) {
    if (given("time.of"))
      return ground(guess.info.time_of == TimeOrigin::absolute
                        ? "They count from a fixed moment, as given."
                        : std::string("They count from the sweep's ") + core::name_of(guess.info.time_of) +
                              ", as given.");
    const CloudSample &first = lidar.samples.front(), &last = lidar.samples.back();
    const double stamps_s = core::seconds(last.stamp - first.stamp),
                 times_s = (last.last_time - first.last_time) * unit_s,
                 beyond_s = std::max(std::abs(first.first_time), std::abs(first.last_time)) * unit_s;
    // Times from the stamp start anew in each scan; absolute ones go on as the stamps do.
    const bool go_on = stamps_s > 0.01 && std::abs(times_s - stamps_s) < 0.5 * stamps_s;
    if (go_on && beyond_s > 1e-9) {
      guess.info.time_of = TimeOrigin::absolute;
      ground("They count from a fixed moment: they go on from scan to scan as the stamps do.");
      return;
    }
    if (beyond_s > 1.5)
      return doubt(
          "The points' times neither count from the stamp nor go on as the stamps do: say what they count "
          "from with time.of.");
    guess.info.time_of = TimeOrigin::start;
    guess.info.stamp_of = StampMoment::start;
    ground(first.last_time > -first.first_time
               ? "They count from the scan's stamp, which is the start of the sweep."
               : "They count back from the scan's stamp, which is the end of the sweep.");
  }

  void guess_rings(const CloudFacts& lidar, const Kind& kind) {
    if (guess.info.rings_by != RingSource::automatic) return;
    if (kind.name == "Livox" || !field_with(lidar, Role::ring)) {
      guess.info.rings_by = guess.info.rings > 0 ? RingSource::automatic : RingSource::none;
      if (guess.info.rings_by == RingSource::none)
        ground(kind.name == "Livox" ? "A Livox has no rings."
                                    : "The points have no rings: they are used without.");
      return;
    }
    guess.info.rings_by = RingSource::field;
    int rings = 0;
    for (const CloudSample& s : lidar.samples) rings = std::max(rings, s.rings);
    ground("The field " + field_with(lidar, Role::ring)->name + " has the rings, " + std::to_string(rings) +
           " of them.");
  }

  const ImuFacts* choose_imu(const CloudFacts& lidar) {
    const std::string& wanted = guess.info.imu_topic;
    if (wanted == "none") return nullptr;
    std::vector<const ImuFacts*> candidates;
    for (const ImuFacts& i : survey_.imus)
      if (i.samples > 0 && (wanted == "auto" || i.topic == wanted)) candidates.push_back(&i);
    if (candidates.empty()) {
      if (wanted != "auto") doubt("The topic " + wanted + " of bag.imu has no sensor_msgs/Imu.");
      return nullptr;
    }
    if (candidates.size() == 1) return candidates.front();
    std::erase_if(candidates,
                  [&](const ImuFacts* i) { return namespace_of(i->topic) != namespace_of(lidar.topic); });
    if (candidates.size() == 1) return candidates.front();
    ground(
        "Several topics have an IMU, and none is the LiDAR's by its name: none is used; choose with "
        "bag.imu.");
    return nullptr;
  }

  void guess_force_unit(const ImuFacts& imu) {
    if (imu.mean_force > 0.5 && imu.mean_force < 2) {
      guess.info.imu_force_unit = ForceUnit::g;
      ground("The specific force of " + imu.topic + " is in g: its mean is " +
             std::to_string(imu.mean_force) + ".");
    }
  }

  /// The body's frame is base_link where transforms lead to it, else the IMU's, else the LiDAR's. What the
  /// recording file says goes before that, key by key.
  void guess_mounting(const CloudFacts& lidar, const ImuFacts* imu, bool imu_named) {
    const bool imu_by_hand = imu && (imu_named || given("imu.rotation"));
    const bool mounted =
        mount_by_transforms(lidar, imu, true) || (imu_by_hand && mount_by_transforms(lidar, imu, false));
    const bool by_hand = given("lidar.position") || given("lidar.rotation") || given("imu.rotation");
    if (!mounted && !by_hand) ground("The body's frame is the LiDAR's, " + lidar.frame + ".");
    if (by_hand) ground("Of the mounting, what is given is used.");
    if (!imu || guess.info.imu_topic == imu->topic) return;
    if (!imu_by_hand)
      return ground("The IMU " + imu->topic + " is not used: no transform tells how its frame, " +
                    imu->frame +
                    ", is turned against the LiDAR's. Name it with bag.imu, and give imu.rotation.");
    guess.info.imu_topic = imu->topic;
    ground("The IMU " + imu->topic + " is used as the recording file says" +
           (given("imu.rotation") ? "." : ", as if its frame were the body's: imu.rotation is not given."));
  }

  /// True if transforms connect the LiDAR with a body, and the IMU too where it is asked for.
  bool mount_by_transforms(const CloudFacts& lidar, const ImuFacts* imu, bool with_imu) {
    std::vector<std::string> bodies{"base_link", "body"};
    const bool of_imu = imu && with_imu;
    if (of_imu) bodies.push_back(imu->frame);
    for (const std::string& body : bodies) {
      const auto T_body_lidar = find_transform(survey_.transforms, body, lidar.frame);
      const auto T_body_imu = of_imu ? find_transform(survey_.transforms, body, imu->frame) : core::Pose{};
      if (!T_body_lidar || !T_body_imu) continue;
      guess.info.lidar_position = three(T_body_lidar->position);
      guess.info.lidar_rotation = degrees_of(T_body_lidar->orientation);
      if (of_imu) guess.info.imu_rotation = degrees_of(T_body_imu->orientation);
      if (of_imu) guess.info.imu_topic = imu->topic;
      ground(of_imu && imu->frame == lidar.frame && body == imu->frame
                 ? "LiDAR and IMU " + imu->topic + " have the same frame, " + body + "."
                 : "/tf_static tells how the sensors are mounted on " + body +
                       (of_imu ? ", IMU " + imu->topic : "") + ".");
      return true;
    }
    return false;
  }

  /// The recording file says it.
  bool given(const char* key) const { return keys_.contains(key); }

  const BagSurvey& survey_;
  const std::set<std::string>& keys_;
};

/// The settings that the bag itself has, except `keys`. What is wrong with one is a doubt.
void apply(const RecordedSettings& settings, const std::set<std::string>& keys, RecordingInfo& info,
           std::vector<std::string>* doubts) {
  core::OptionTable table;
  describe(table, info);
  for (const auto& [key, value] : settings) try {
      if (!keys.contains(key)) table.set(std::string("the bag's record ") + kRecordedSettings, key, value);
    } catch (const core::InputError& e) {
      if (doubts) doubts->push_back(std::string(e.what()) + ": give the key with --info.");
    }
}
std::string text_of(const RecordedSettings& settings, const std::set<std::string>& keys) {
  std::string text;
  for (const auto& [key, value] : settings)
    if (!keys.contains(key)) text += (text.empty() ? "" : ", ") + key + " " + value;
  return text;
}

bool has_controls(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}
/// Names of topics are a bag's, and may have anything.
std::string info_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace

RecordingGuess guess_recording(const BagSurvey& survey, const RecordingInfo& given,
                               const std::set<std::string>& keys) {
  RecordingInfo known = given;
  std::vector<std::string> doubts;
  apply(survey.settings, keys, known, &doubts);
  std::set<std::string> known_keys = keys;
  for (const auto& [key, value] : survey.settings) known_keys.insert(key);
  Guesser guesser(survey, known, known_keys);
  if (const std::string text = text_of(survey.settings, keys); !text.empty())
    guesser.guess.grounds.push_back(std::string("The bag's record ") + kRecordedSettings + " gives " + text +
                                    ".");
  guesser.work();
  RecordingGuess guess = std::move(guesser.guess);
  apply(survey.settings, keys, guess.info, nullptr);  // above the transforms
  guess.doubts.insert(guess.doubts.begin(), doubts.begin(), doubts.end());
  return guess;
}

std::string comment_text(std::string_view text) {
  std::string line = core::printable(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return line;
}

std::string recording_info_text(const RecordingGuess& guess) {
  std::string text;
  for (const std::string& g : guess.grounds) text += "; " + comment_text(g) + "\n";
  for (const std::string& d : guess.doubts) text += "; OPEN: " + comment_text(d) + "\n";
  RecordingInfo info = guess.info, usual;
  core::OptionTable table, defaults;
  describe(table, info);
  describe(defaults, usual);
  const auto values = core::leaves_of(table.resolved()), unset = core::leaves_of(defaults.resolved());
  std::string section;  // rows of a section follow each other
  const auto enter = [&](const std::string& name) {
    if (name == section) return;
    if (!section.empty()) text += "}\n";
    if (!name.empty()) text += name + " {\n";
    section = name;
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& [key, value] = values[i];
    if (value == unset[i].second) continue;
    const auto dot = key.find('.');
    if (has_controls(value)) {
      text += "; " + key + " \"" + comment_text(value) +
              "\": a recording file cannot have its control characters\n";
      continue;
    }
    enter(dot == std::string::npos ? "" : key.substr(0, dot));
    text += (section.empty() ? "" : "  ") + key.substr(dot == std::string::npos ? 0 : dot + 1) + " " +
            info_text(value) + "\n";
  }
  enter("");
  return text;
}

}  // namespace karst::replay
