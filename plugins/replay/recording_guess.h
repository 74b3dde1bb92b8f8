// What a bag's messages tell of its sensors: the keys of a recording.info, each with its evidence.
#pragma once
#include <string>
#include <vector>

#include "plugins/replay/bag/bag_survey.h"
#include "plugins/replay/recording_info.h"

namespace karst::replay {

struct RecordingGuess {
  RecordingInfo info;                // lidar_topic and imu_topic name topics, or "none"
  std::string lidar;                 // "Ouster", "Livox" ...; "" without one
  std::vector<std::string> grounds;  // what was assumed, and why, a sentence each
  std::vector<std::string> doubts;   // what a recording.info has to say before a replay, a sentence each
};

/// `given`: what a recording file says, and `keys`: of what. Its units, origins and topics are not guessed
/// anew; the mounting is, and `read_recording_info` puts the file's keys above it. What the bag's own
/// settings say goes before what is guessed, and behind the recording file.
RecordingGuess guess_recording(const BagSurvey& survey, const RecordingInfo& given = {},
                               const std::set<std::string>& keys = {});

/// `text` as part of a comment, whatever a bag's names have in them: on one line, and without control
/// characters.
std::string comment_text(std::string_view text);

/// The keys that are not at their defaults, as text of a recording.info, with the grounds as comments.
std::string recording_info_text(const RecordingGuess& guess);

}  // namespace karst::replay
