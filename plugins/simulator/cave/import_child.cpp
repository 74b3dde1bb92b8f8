#include "plugins/simulator/cave/import_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <string>

#include "core_stack/common/error.h"
#include "core_stack/common/sanitized.h"

namespace karst::cave {
namespace {

using core::InputError;

constexpr std::uint64_t kMinMemory = std::uint64_t{2} << 30, kMemoryPerByte = 100;
/// Importers take less than a second for a megabyte; a few bytes can send them into an endless loop.
constexpr std::uint64_t kMinCpu_s = 5, kBytesPerCpu_s = 100'000;
constexpr std::uint64_t kMaxReason = 4000;
constexpr int kOutOfMemory = 3;  // the child's exit code

enum class Answer : std::uint64_t { mesh = 1, refused = 2 };
struct AnswerHead {
  Answer kind;
  std::uint64_t vertices = 0, triangles = 0;  // for a failure, `vertices` is the length of the reason
};

std::uint64_t address_space_in_use() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void set_limit(int resource, std::uint64_t value, std::uint64_t beyond = 0) {
  const rlimit limit{value, value + beyond};
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Applies the limits to this process, the child.
void confine(const ImportLimits& limits, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent has ended already
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGXCPU}) std::signal(signal, SIG_DFL);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, limits.cpu_s, 5);  // at the hard limit it would be killed without a reason
  if (!kSanitized) set_limit(RLIMIT_AS, address_space_in_use() + limits.memory_bytes);
  if (const int null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
}

bool write_all(int to, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = write(to, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// The end of the pipe from the child.
struct FromChild {
  int pipe, silence_ms;
};

bool read_all(const FromChild& from, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    pollfd ready{from.pipe, POLLIN, 0};
    const int polled = poll(&ready, 1, from.silence_ms);
    if (polled < 0 && errno == EINTR) continue;
    if (polled <= 0) return false;
    const ssize_t n = read(from.pipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

template <class T>
bool write_array(int to, const std::vector<T>& items) {
  return write_all(to, items.data(), items.size() * sizeof(T));
}

/// Reads in pieces, so that a child that announces too many items costs no more memory than it sends.
template <class T>
bool read_array(const FromChild& from, std::uint64_t count, std::vector<T>& items) {
  constexpr std::uint64_t kPiece = 1 << 16;
  while (items.size() < count) {
    const std::size_t before = items.size();
    items.resize(before + static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, count - before)));
    if (!read_all(from, items.data() + before, (items.size() - before) * sizeof(T))) return false;
  }
  return true;
}

/// The main function of the child.
[[noreturn]] void serve(int to, const std::function<TriangleMesh()>& import, const ImportLimits& limits,
                        pid_t parent) {
  confine(limits, parent);
  int code = 1;
  try {
    const TriangleMesh mesh = import();
    const AnswerHead head{Answer::mesh, mesh.vertices.size(), mesh.triangles.size()};
    if (write_all(to, &head, sizeof head) && write_array(to, mesh.vertices) &&
        write_array(to, mesh.triangles))
      code = 0;
  } catch (const std::bad_alloc&) {
    code = kOutOfMemory;
  } catch (const std::exception& e) {
    const std::string reason = std::string(e.what()).substr(0, kMaxReason);
    const AnswerHead head{Answer::refused, reason.size(), 0};
    if (write_all(to, &head, sizeof head) && write_all(to, reason.data(), reason.size())) code = 0;
  } catch (...) {
  }
  _exit(code);
}

struct Told {
  TriangleMesh mesh;
  std::string refusal;  // a whole message, with the file's name
};

std::optional<Told> read_answer(const FromChild& from) {
  AnswerHead head{};
  Told told;
  if (!read_all(from, &head, sizeof head)) return std::nullopt;
  if (head.kind == Answer::refused) {
    told.refusal.resize(static_cast<std::size_t>(std::min(head.vertices, kMaxReason)));
    if (told.refusal.empty() || !read_all(from, told.refusal.data(), told.refusal.size()))
      return std::nullopt;
    return told;
  }
  if (head.kind != Answer::mesh || !read_array(from, head.vertices, told.mesh.vertices) ||
      !read_array(from, head.triangles, told.mesh.triangles))
    return std::nullopt;
  return told;
}

bool is_sound(const TriangleMesh& mesh) {
  const auto finite = [](const core::Vec3f& v) { return v.allFinite(); };
  const auto named = [n = mesh.vertices.size()](const std::array<std::uint32_t, 3>& t) {
    return t[0] < n && t[1] < n && t[2] < n;
  };
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), finite) &&
         std::all_of(mesh.triangles.begin(), mesh.triangles.end(), named);
}

std::string end_of(pid_t child, const char* worker) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return "it takes more processor time than any cave should";
  if (WIFSIGNALED(status)) return worker + std::string(" broke on it (") + strsignal(WTERMSIG(status)) + ")";
  if (WEXITSTATUS(status) == kOutOfMemory) return "it takes more memory than any cave should";
  return WEXITSTATUS(status) == 0 ? "" : worker + std::string(" gave no answer");
}

}  // namespace

TriangleMesh import_in_child(const std::string& path, const std::function<TriangleMesh()>& import,
                             ImportLimits limits, const ImportWords& words) {
  const std::uint64_t file_bytes = std::filesystem::file_size(path);
  if (limits.memory_bytes == 0) limits.memory_bytes = std::max(kMinMemory, kMemoryPerByte * file_bytes);
  if (limits.cpu_s == 0) limits.cpu_s = kMinCpu_s + file_bytes / kBytesPerCpu_s;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw InputError(path, "", std::strerror(errno));
  const pid_t parent = getpid(), child = fork();
  if (child == 0) serve(ends[1], import, limits, parent);
  close(ends[1]);
  std::optional<Told> told;
  if (child > 0) told = read_answer({ends[0], 1000 * limits.silence_s});
  if (child > 0 && !told) kill(child, SIGKILL);  // if it has not ended by now, it never would
  close(ends[0]);
  if (child < 0) throw InputError(path, "", "no process can be started to read it");
  const std::string end = end_of(child, words.worker);
  const auto refuse = [&](const std::string& why) {
    throw InputError(path, "", words.failed + (": " + why));
  };
  if (!end.empty()) refuse(end);
  if (!told) refuse(words.worker + std::string(" gave no answer"));
  if (!told->refusal.empty()) {
    const std::string own = path + ": ";  // the child named the file already
    throw InputError(path, "",
                     told->refusal.starts_with(own) ? told->refusal.substr(own.size()) : told->refusal);
  }
  if (!is_sound(told->mesh)) refuse(words.worker + std::string("'s answer makes no sense"));
  return std::move(told->mesh);
}

}  // namespace karst::cave
