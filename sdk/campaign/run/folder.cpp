#include "sdk/campaign/run/folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core_stack/common/error.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::InputError;

constexpr std::size_t kChangesNamed = 5;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : descriptor_(-1) {
  make_folder(folder);
  const fs::path file = folder / "lock";
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    throw InputError(file.string(), "", std::string("cannot be written: ") + std::strerror(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  close(descriptor_);
  throw InputError(folder.string(), "",
                   "another campaign is writing here; wait for it, or choose another --out");
}

FolderLock::~FolderLock() { close(descriptor_); }

Store open_for(const Plan& plan, const fs::path& folder, AcceptedBinaries binaries,
               const std::string& source) {
  const fs::path file = folder / "campaign.sqlite";
  if (!fs::exists(file)) return Store::create(file, head_of(plan));
  Store store = Store::open(file);
  const Plan then = plan_of(store.head().definition, file.string());
  const std::vector<std::string> differences = changes(then, plan, binaries);
  if (!differences.empty()) {
    std::string text;
    for (std::size_t i = 0; i < std::min(differences.size(), kChangesNamed); ++i)
      text += "\n  " + differences[i];
    if (differences.size() > kChangesNamed)
      text += "\n  and " + std::to_string(differences.size() - kChangesNamed) + " more";
    throw InputError(source, "",
                     "is another campaign than the one in " + file.string() +
                         ", which cannot be gone on with; choose another --out. It differs:" + text);
  }
  Plan same_metric = plan;
  same_metric.metric = then.metric;
  if (const StoreHead head = head_of(same_metric); head.definition != store.head().definition)
    store.extend(head);
  return store;
}

fs::path mission_file(const Plan& plan, const TrialKey& trial) {
  const auto& [contestant, cave, seed] = trial;
  return fs::path("missions") / plan.contestants.at(contestant).name / (plan.caves.at(cave).name + ".info");
}

void write_missions(const Plan& plan, const fs::path& folder) {
  for (std::size_t k = 0; k < plan.contestants.size(); ++k)
    for (std::size_t c = 0; c < plan.caves.size(); ++c) {
      const fs::path file = folder / mission_file(plan, {k, c, 0});
      make_folder(file.parent_path());
      evaluation::write_whole_file(file, mission_text(plan, k, c));
    }
}

}  // namespace karst::campaign
