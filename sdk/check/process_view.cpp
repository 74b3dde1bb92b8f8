#include "sdk/check/process_view.h"

#include <malloc.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

/// A sanitizer's own heap, of which mallinfo2 knows nothing (sanitizer/allocator_interface.h); null without
/// one.
extern "C" [[gnu::weak]] std::size_t
__sanitizer_get_current_allocated_bytes();  // NOLINT(bugprone-reserved-identifier): its name

namespace karst::check {
namespace {

namespace fs = std::filesystem;

std::array<long, 2> output_bytes() {
  std::fflush(nullptr);
  std::array<long, 2> out{};
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat s {};
    if (fstat(descriptor, &s) == 0) out[static_cast<std::size_t>(descriptor - 1)] = s.st_size;
  }
  return out;
}

std::vector<std::string> open_files() {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    const fs::path target = fs::read_symlink(entry.path(), gone);
    if (!gone && target.string().find("/proc/") == std::string::npos)
      out.push_back(entry.path().filename().string() + " -> " + target.string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::string environment() {
  std::string out;
  for (char** e = environ; e != nullptr && *e != nullptr; ++e) out += std::string(*e) + "\n";
  return out;
}

mode_t current_umask() {
  const mode_t mask = umask(0);
  umask(mask);
  return mask;
}

std::size_t status_kib(const char* key) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key)) return std::stoul(line.substr(std::strlen(key)));
  return 0;
}

}  // namespace

ProcessView::ProcessView()
    : output_bytes_(output_bytes()),
      threads_(thread_count()),
      files_(open_files()),
      folder_(fs::current_path().string()),
      environment_(environment()),
      umask_(current_umask()) {
  for (int s = 1; s < kSignals; ++s) sigaction(s, nullptr, &actions_[static_cast<std::size_t>(s)]);
  pthread_sigmask(SIG_SETMASK, nullptr, &mask_);
}

std::string ProcessView::output_since() const {
  const std::array<long, 2> now = output_bytes();
  if (now[0] != output_bytes_[0])
    return std::to_string(now[0] - output_bytes_[0]) + " bytes were written to stdout";
  if (now[1] != output_bytes_[1])
    return std::to_string(now[1] - output_bytes_[1]) + " bytes were written to stderr";
  return "";
}

std::string ProcessView::threads_since() const {
  for (int i = 0; i < 100 && thread_count() > threads_; ++i)  // a joined thread may still be listed
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const std::size_t now = thread_count();
  return now > threads_ ? std::to_string(now - threads_) + " more threads are running" : "";
}

std::string ProcessView::signals_since() const {
  for (int s = 1; s < kSignals; ++s) {
    struct sigaction now {};
    sigaction(s, nullptr, &now);
    if (now.sa_handler != actions_[static_cast<std::size_t>(s)].sa_handler)
      return "the handler of signal " + std::to_string(s) + " (" + strsignal(s) + ") is another";
  }
  sigset_t mask;
  pthread_sigmask(SIG_SETMASK, nullptr, &mask);
  for (int s = 1; s < kSignals; ++s)
    if (sigismember(&mask, s) != sigismember(&mask_, s))
      return "signal " + std::to_string(s) + " (" + strsignal(s) + ") is " +
             (sigismember(&mask, s) == 1 ? "blocked" : "no longer blocked");
  return "";
}

std::string ProcessView::leftovers_since() const {
  for (const std::string& file : open_files())
    if (!std::binary_search(files_.begin(), files_.end(), file)) return "a file is still open: " + file;
  if (fs::current_path().string() != folder_) return "the working folder is another";
  if (current_umask() != umask_) return "the file mode mask is another";
  if (environment() != environment_) return "the environment is another";
  return "";
}

std::size_t thread_count() {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator()));
}

std::size_t heap_bytes() {
  if (__sanitizer_get_current_allocated_bytes != nullptr) return __sanitizer_get_current_allocated_bytes();
  const struct mallinfo2 m = mallinfo2();
  return m.uordblks + m.hblkhd;
}

std::size_t resident_bytes() { return status_kib("VmRSS:") * 1024; }
std::size_t peak_bytes() { return status_kib("VmHWM:") * 1024; }
void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

}  // namespace karst::check
