#include "core_stack/common/input_file.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISCHR(mode) || S_ISBLK(mode) ? "a device" : "something else";
}

[[noreturn]] void fail_to_open(const std::string& file) {
  const std::string reason = errno == ENOENT ? "no such file" : std::strerror(errno);
  throw InputError(file, "", "cannot be opened: " + reason);
}

/// A file of the kernel's own (/proc, /sys): a regular file of size 0 that may never end, or act when read.
bool is_of_the_kernel(const struct statfs& system) {
  constexpr std::array kKernels = {PROC_SUPER_MAGIC, SYSFS_MAGIC,        DEBUGFS_MAGIC,      TRACEFS_MAGIC,
                                   SECURITYFS_MAGIC, CGROUP_SUPER_MAGIC, CGROUP2_SUPER_MAGIC};
  return std::any_of(kKernels.begin(), kKernels.end(), [&](auto magic) {
    return static_cast<long>(system.f_type) == static_cast<long>(magic);
  });
}

void check(const std::string& file, const struct stat& status, const struct statfs& system,
           std::uintmax_t max_bytes) {
  if (!S_ISREG(status.st_mode))
    throw InputError(file, "", "is " + std::string(kind_of(status.st_mode)) + ", not a regular file");
  if (is_of_the_kernel(system)) throw InputError(file, "", "is a file of the kernel, not a regular file");
  if (const auto size = static_cast<std::uintmax_t>(status.st_size); size > max_bytes)
    throw InputError(file, "",
                     "is " + std::to_string(size) + " bytes long; more than " + std::to_string(max_bytes) +
                         " are not read");
}

/// A descriptor that names a file without opening it: no FIFO blocks, no device notices.
class Handle {
 public:
  explicit Handle(const std::string& file) : descriptor_(open(file.c_str(), O_PATH | O_CLOEXEC)) {
    if (descriptor_ < 0) fail_to_open(file);
  }
  ~Handle() { close(descriptor_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  int descriptor() const { return descriptor_; }
  /// Opening this name opens the same file, whatever stands under the old name by then.
  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace

void check_input(const std::string& file, std::uintmax_t max_bytes) {
  struct stat status {};
  struct statfs system {};
  if (stat(file.c_str(), &status) != 0 || statfs(file.c_str(), &system) != 0) fail_to_open(file);
  check(file, status, system, max_bytes);
}

std::ifstream open_input(const std::string& file, std::uintmax_t max_bytes) {
  const Handle handle(file);
  struct stat status {};
  struct statfs system {};
  if (fstat(handle.descriptor(), &status) != 0 || fstatfs(handle.descriptor(), &system) != 0)
    fail_to_open(file);
  check(file, status, system, max_bytes);
  std::ifstream in(handle.name(), std::ios::binary);
  if (!in) fail_to_open(file);
  return in;
}

std::string read_input(const std::string& file, std::uintmax_t max_bytes) {
  std::ifstream in = open_input(file, max_bytes);
  std::ostringstream all;
  all << in.rdbuf();
  if (in.bad()) throw InputError(file, "", "cannot be read");
  return std::move(all).str();
}

}  // namespace karst::core
