// Commands with their output, as the documentation shows them: run as typed, and compared.
//
//   ```console
//   $ karst policy new my_nearest
//   my_nearest: starts as: flies to the nearest frontier
//   ...
//   ```
// A line "..." stands for any lines. With KARST_ACCEPT=1 in the environment the output in the file is
// replaced by what was printed, except where it holds "...".
#pragma once
#include <string>
#include <vector>

#include "tests/closed_loop/command.h"

namespace karst {

struct TypedCommand {
  std::size_t line;  // of the command in the document
  std::string command;
  std::vector<std::string> output;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// The contents of the blocks ```KIND of a document.
inline std::vector<std::vector<std::string>> blocks_of(const std::string& document, const std::string& kind) {
  std::vector<std::vector<std::string>> out;
  bool inside = false;
  for (const std::string& line : lines_of(document)) {
    if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      out.back().push_back(line);
    } else if (line == "```" + kind) {
      inside = true;
      out.emplace_back();
    }
  }
  return out;
}

/// The commands of the blocks ```console, each with the lines that follow it.
inline std::vector<TypedCommand> typed_commands(const std::string& document) {
  std::vector<TypedCommand> out;
  bool inside = false;
  std::size_t number = 0;
  for (const std::string& line : lines_of(document)) {
    ++number;
    if (line == "```console" || line == "```") {
      inside = line == "```console";
    } else if (inside && line.starts_with("$ ")) {
      out.push_back({number, line.substr(2), {}});
    } else if (inside && !out.empty()) {
      out.back().output.push_back(line);
    }
  }
  return out;
}

/// Whether `got` is `expected`, in which "..." stands for any lines.
inline bool matches(const std::vector<std::string>& expected, std::size_t e,
                    const std::vector<std::string>& got, std::size_t g) {
  if (e == expected.size()) return g == got.size();
  if (expected[e] != "...")
    return g < got.size() && expected[e] == got[g] && matches(expected, e + 1, got, g + 1);
  for (std::size_t skip = g; skip <= got.size(); ++skip)
    if (matches(expected, e + 1, got, skip)) return true;
  return false;
}

/// A shell that remembers its folder from one command to the next, with this build's karst on its path and a
/// home of its own.
class Shell {
 public:
  explicit Shell(const std::filesystem::path& folder, std::string bin = KARST_BINARY_DIR "/bin")
      : home_(folder), at_(folder), bin_(std::move(bin)) {}

  Output run(const std::string& command) {
    const std::filesystem::path where = home_ / ".where";
    const Output out = run_command("{ cd " + at_.string() + " && export HOME=" + home_.string() +
                                   " XDG_DATA_HOME= PATH=" + bin_ + ":$PATH && { " + command +
                                   "\n} && pwd > " + where.string() + "; }");
    if (out.code == 0) at_ = lines_of(bytes_of(where)).at(0);
    return out;
  }

 private:
  std::filesystem::path home_, at_;
  std::string bin_;
};

/// Runs the commands of a document in an empty folder; their output must be what it says.
inline void expect_as_documented(const std::filesystem::path& file, const std::filesystem::path& folder) {
  Shell shell(folder);
  std::vector<std::string> document = lines_of(bytes_of(file));
  std::vector<TypedCommand> commands = typed_commands(bytes_of(file));
  ASSERT_FALSE(commands.empty()) << file;
  const bool accept = std::getenv("KARST_ACCEPT") != nullptr;
  long shift = 0;  // of lines in `document`, by what was accepted
  for (const TypedCommand& typed : commands) {
    const Output out = shell.run(typed.command);
    ASSERT_EQ(out.code, 0) << file << ":" << typed.line << ": " << typed.command << "\n" << out.text;
    const std::vector<std::string> got = lines_of(out.text);
    const bool open = std::find(typed.output.begin(), typed.output.end(), "...") != typed.output.end();
    if (accept && !open) {
      const auto first = document.begin() + static_cast<long>(typed.line) + shift;
      const auto next = document.erase(first, first + static_cast<long>(typed.output.size()));
      document.insert(next, got.begin(), got.end());
      shift += static_cast<long>(got.size()) - static_cast<long>(typed.output.size());
    } else {
      EXPECT_TRUE(matches(typed.output, 0, got, 0))
          << file.string() << ":" << typed.line << ": " << typed.command << "\nprinted:\n"
          << out.text;
    }
  }
  if (!accept) return;
  std::ofstream rewritten(file);
  for (const std::string& line : document) rewritten << line << "\n";
}

}  // namespace karst
