// Surveys for tests: files in a folder of their own, and what is found in what was read.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core_stack/common/error.h"
#include "sdk/survey/readings.h"
#include "sdk/survey/survey.h"
#include "sdk/survey/therion_reader.h"
#include "tests/unit/replay/folder.h"
#include "tests/unit/survey/skip_without_survex.h"

namespace karst::test {

inline std::string centreline(const std::string& lines) {
  return "survey s\ncentreline\n" + lines + "endcentreline\nendsurvey\n";
}

/// The readings of a centreline of these lines; its first one is line 3 of the file.
inline survey::Readings readings_of(const std::string& lines) {
  const Folder folder;
  return survey::read_therion(folder.write("s.th", centreline(lines)));
}

/// What a reader says of text that it refuses; empty if it takes it.
inline std::string refusal_of_text(const std::string& text) {
  const Folder folder;
  try {
    survey::read_therion(folder.write("s.th", text));
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}
inline std::string refusal_of(const std::string& lines) { return refusal_of_text(centreline(lines)); }

inline bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
inline bool notes_say(const std::vector<survey::Note>& notes, const std::string& part) {
  return std::any_of(notes.begin(), notes.end(), [&](const auto& n) { return says(n.text, part); });
}

/// A station by its full name or an alias.
inline const survey::Station& station(const survey::Survey& survey, const std::string& name) {
  for (const survey::Station& s : survey.stations)
    if (s.name == name || std::find(s.aliases.begin(), s.aliases.end(), name) != s.aliases.end()) return s;
  throw std::runtime_error("no station " + name);
}
inline core::Vec3 place(const survey::Survey& survey, const std::string& name) {
  return station(survey, name).position_m;
}

}  // namespace karst::test
