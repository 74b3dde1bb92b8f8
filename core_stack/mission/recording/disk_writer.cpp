#include "core_stack/mission/recording/disk_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <set>
#include <utility>

#include "core_stack/common/error.h"

namespace karst::core {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPeriod{500};

bool write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n > 0)
      done += static_cast<std::size_t>(n);
    else if (errno != EINTR)
      return false;
  }
  return true;
}

}  // namespace

DiskWriter::DiskWriter(fs::path folder) : folder_(std::move(folder)), thread_([this] { run(); }) {}

DiskWriter::~DiskWriter() {
  finish();
  for (const int d : descriptors_) ::close(d);
}

DiskWriter::File DiskWriter::open(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0)
    throw InputError(path.string(), "", std::string("cannot be written: ") + std::strerror(errno));
  const std::lock_guard lock(mutex_);
  descriptors_.push_back(descriptor);
  return descriptors_.size() - 1;
}

bool DiskWriter::append(File file, std::string& bytes) {
  const std::lock_guard lock(mutex_);
  return take({file, std::exchange(bytes, {})});
}

bool DiskWriter::try_append(File file, std::string& bytes) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return !lock || take({file, std::exchange(bytes, {})});
}

bool DiskWriter::write_whole(const fs::path& path, std::string& bytes) {
  const std::lock_guard lock(mutex_);
  return take({{}, std::exchange(bytes, {}), path});
}

bool DiskWriter::take(Pending pending) {
  if (pending_bytes_ + pending.bytes.size() > kMaxPending) failed_ = true;
  if (!failed_ && !over_ && !pending.bytes.empty()) {
    pending_bytes_ += pending.bytes.size();
    pending_.push_back(std::move(pending));
  }
  return !failed_;
}

bool DiskWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  return !failed_;
}

void DiskWriter::run() {
  guarded([this] { sync_folder((fs::absolute(folder_) / "").parent_path().parent_path()); });
  for (bool last = false; !last;)
    guarded([&] {
      std::vector<Pending> batch;
      {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, kPeriod, [this] { return over_; });
        last = over_;
        batch.swap(pending_);
        pending_bytes_ = 0;
      }
      std::set<FileId> synced;
      if (!write(batch, synced)) fail();
      sync_others(synced);
    });
}

/// Out of memory, or whatever else fails here, costs the record, never the flight.
template <class Step>
void DiskWriter::guarded(const Step& step) {
  try {
    step();
  } catch (...) {
    fail();
  }
}

void DiskWriter::fail() {
  const std::lock_guard lock(mutex_);
  failed_ = true;
}

/// A file that cannot be written does not prevent the others from being written.
bool DiskWriter::write(const std::vector<Pending>& batch, std::set<FileId>& synced) {
  std::vector<int> descriptors;
  {
    const std::lock_guard lock(mutex_);
    descriptors = descriptors_;
  }
  std::set<int> written;
  bool good = true;
  for (const Pending& p : batch) {
    if (!p.whole.empty()) {
      good = write_new(p, synced) && good;
      continue;
    }
    good = write_all(descriptors[p.file], p.bytes) && good;
    written.insert(descriptors[p.file]);
  }
  for (const int d : written) {
    const bool is_synced = fdatasync(d) == 0;
    good = (is_synced || errno == EINVAL) && good;  // EINVAL: no disk below it
    struct stat is {};
    if (is_synced && fstat(d, &is) == 0) synced.insert({is.st_dev, is.st_ino});
  }
  return good;
}

bool DiskWriter::write_new(const Pending& p, std::set<FileId>& synced) {
  const int d = ::open(p.whole.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (d < 0) return false;
  bool good = write_all(d, p.bytes);
  const bool is_synced = fdatasync(d) == 0;
  good = (is_synced || errno == EINVAL) && good;
  struct stat is {};
  if (is_synced && fstat(d, &is) == 0) synced.insert({is.st_dev, is.st_ino});
  return ::close(d) == 0 && good;
}

/// What is not this writer's is synced as far as possible: the flight does not depend on it.
void DiskWriter::sync_others(const std::set<FileId>& synced) {
  std::error_code error;
  std::set<fs::path> grown;  // folders with new files
  for (fs::recursive_directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    struct stat is {};
    if (lstat(at->path().c_str(), &is) != 0 || !S_ISREG(is.st_mode)) continue;
    const Seen now{static_cast<std::uintmax_t>(is.st_size),
                   std::int64_t{is.st_mtim.tv_sec} * 1'000'000'000 + is.st_mtim.tv_nsec};
    const auto [found, is_new] = seen_.try_emplace(at->path());
    if (is_new) grown.insert(at->path().parent_path());
    if (!is_new && found->second.size == now.size && found->second.changed_ns == now.changed_ns) continue;
    found->second = now;
    if (!synced.contains({is.st_dev, is.st_ino})) sync(at->path());
  }
  for (const fs::path& folder : grown) sync_folder(folder);
  if (!grown.empty()) sync_folder(folder_);
}

void DiskWriter::sync(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  fdatasync(descriptor);
  ::close(descriptor);
}

void DiskWriter::sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY);
  if (descriptor < 0) return;
  fsync(descriptor);
  ::close(descriptor);
}

}  // namespace karst::core
