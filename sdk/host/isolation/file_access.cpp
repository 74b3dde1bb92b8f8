#include "sdk/host/isolation/file_access.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#include "core_stack/common/error.h"
#include "sdk/host/isolation/descriptor.h"
#include "sdk/host/plugin/script_file.h"

namespace karst::host {
namespace {

/// The access rights of the first version of the interface, which any kernel with Landlock supports.
constexpr std::uint64_t kReading = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kHandled =
    kReading | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
    LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR |
    LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
    LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;

constexpr const char* kOfTheSystem[] = {
    "/usr", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/localtime",
    // this process and the processor, which libraries of linear algebra ask for
    "/proc/self", "/proc/cpuinfo", "/proc/meminfo", "/proc/stat", "/sys/devices/system/cpu",
    "/sys/devices/system/node", "/dev/null", "/dev/zero", "/dev/urandom", "/dev/random"};

[[noreturn]] void cannot(const char* what) {
  throw core::InputError("a policy's process", "",
                         std::string("reading cannot be confined: ") + what + ": " + std::strerror(errno));
}

void allow_reading(int rules, const std::filesystem::path& place) {
  const Descriptor at(open(place.c_str(), O_PATH | O_CLOEXEC));
  struct stat s {};
  if (at.value < 0 || fstat(at.value, &s) != 0) return;
  landlock_path_beneath_attr rule{};
  rule.parent_fd = at.value;
  rule.allowed_access = S_ISDIR(s.st_mode) ? kReading : std::uint64_t{LANDLOCK_ACCESS_FS_READ_FILE};
  if (syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) cannot(place.c_str());
}

}  // namespace

int landlock_version() {
  const long version =
      syscall(SYS_landlock_create_ruleset, nullptr, std::size_t{0}, LANDLOCK_CREATE_RULESET_VERSION);
  return version > 0 ? static_cast<int>(version) : 0;
}

std::vector<std::filesystem::path> places_to_read(const std::filesystem::path& plugin) {
  std::vector<std::filesystem::path> places(std::begin(kOfTheSystem), std::end(kOfTheSystem));
  if (const char* const folders = std::getenv("LD_LIBRARY_PATH")) {
    std::istringstream in(folders);
    for (std::string folder; std::getline(in, folder, ':');)
      if (!folder.empty()) places.emplace_back(folder);
  }
  if (is_script(plugin)) places.push_back(own_libraries());
  std::error_code error;
  const std::filesystem::path file = std::filesystem::absolute(plugin, error);
  for (const std::filesystem::path& of : {file, std::filesystem::weakly_canonical(file, error)}) {
    places.push_back(of);
    // A plugin in the root directory must not make everything readable.
    if (of.parent_path() != of.root_path()) places.push_back(of.parent_path());
  }
  return places;
}

void read_only_from(const std::vector<std::filesystem::path>& places) {
  if (landlock_version() == 0) return;
  landlock_ruleset_attr all{};
  all.handled_access_fs = kHandled;
  const Descriptor rules(
      static_cast<int>(syscall(SYS_landlock_create_ruleset, &all, sizeof all.handled_access_fs, 0)));
  if (rules.value < 0) cannot("no set of rules");
  for (const std::filesystem::path& place : places) allow_reading(rules.value, place);
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || syscall(SYS_landlock_restrict_self, rules.value, 0) != 0)
    cannot("the rules are not taken");
}

void hide_this_process() { prctl(PR_SET_DUMPABLE, 0, 0, 0, 0); }

}  // namespace karst::host
