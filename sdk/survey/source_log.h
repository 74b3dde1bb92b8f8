// The files that a reader went through, and what it noted on the way.
#pragma once
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/survey/survey.h"

namespace karst::survey {

struct SourceLog {
  std::vector<std::string> files;
  std::vector<Note> notes;
  std::size_t notes_left_out = 0;

  /// What is said of a file again only counts.
  void note(const Source& source, std::string text) {
    const auto [it, is_new] = said_.try_emplace(std::to_string(source.file) + ' ' + text, notes.size());
    if (!is_new)
      ++notes[it->second].more;
    else if (notes.size() < kMaxNotes)
      notes.push_back({source, std::move(text), 0});
    if (is_new && it->second >= kMaxNotes) {
      said_.erase(it);
      ++notes_left_out;
    }
  }
  core::InputError error(const Source& source, const std::string& reason) const {
    return {files.at(source.file), source.line > 0 ? "line " + std::to_string(source.line) : "", reason};
  }

 private:
  std::unordered_map<std::string, std::size_t> said_;
};

}  // namespace karst::survey
