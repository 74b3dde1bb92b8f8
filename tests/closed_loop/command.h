// Runs the `karst` command as a user would.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace karst {

struct Output {
  int code = -1;
  std::string text;  // standard output and standard error together
  bool says(const std::string& part) const { return text.find(part) != std::string::npos; }
};

/// `line` as typed in a shell.
inline Output run_command(const std::string& line) {
  Output out;
  FILE* pipe = popen((line + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    out.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  out.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

/// `arguments` as typed in a shell behind `karst`.
inline Output run_karst(const std::string& arguments) {
  return run_command(std::string(KARST_BINARY_DIR) + "/bin/karst " + arguments);
}

/// How many seeds the tests that take some fly: one, or what KARST_SEEDS says.
inline int seeds() {
  const char* asked = std::getenv("KARST_SEEDS");
  return asked ? std::max(1, std::atoi(asked)) : 1;
}

/// An empty place for one test's files.
inline std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path dir = std::filesystem::path(KARST_BINARY_DIR) / "test_runs" / name;
  std::filesystem::remove_all(dir);
  std::filesystem::create_directories(dir);
  return dir;
}

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

/// A generated cave, made once for all tests of one program; returns its .info file. A cave with settings
/// of its own, `--set KEY=VALUE ...`, needs a name.
inline std::string generated_cave(const std::string& preset, int seed, const std::string& settings = "",
                                  std::string name = "") {
  if (name.empty()) name = preset + std::to_string(seed);
  const std::filesystem::path dir = std::filesystem::path(KARST_BINARY_DIR) / "test_runs" / "caves";
  const std::string stem = (dir / name).string();
  if (!std::filesystem::exists(stem + ".info")) {
    // Several tests may want it at once: each makes its own, and the rename decides.
    const std::string own = stem + "." + std::to_string(getpid());
    std::filesystem::create_directories(own);
    const Output made = run_karst("cave generate --preset " + preset + " --seed " + std::to_string(seed) +
                                  " --out " + own + "/" + name + " " + settings);
    EXPECT_EQ(made.code, 0) << made.text;
    for (const auto& entry : std::filesystem::directory_iterator(own))
      if (entry.path().extension() != ".info")
        std::filesystem::rename(entry.path(), dir / entry.path().filename());
    std::filesystem::rename(own + "/" + name + ".info", stem + ".info");
    std::filesystem::remove_all(own);
  }
  return stem + ".info";
}

}  // namespace karst
