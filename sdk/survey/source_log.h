// The files that a reader went through, and what it noted on the way.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/survey/survey.h"

namespace karst::survey {

struct SourceLog {
  std::vector<std::string> files;
  std::vector<Note> notes;
  std::size_t notes_left_out = 0;

  void note(const Source& source, std::string text) {
    if (notes.size() < kMaxNotes)
      notes.push_back({source, std::move(text)});
    else
      ++notes_left_out;
  }
  core::InputError error(const Source& source, const std::string& reason) const {
    return {files.at(source.file), source.line > 0 ? "line " + std::to_string(source.line) : "", reason};
  }
};

}  // namespace karst::survey
