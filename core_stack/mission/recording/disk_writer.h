// Writes the files of a run directory from a thread of its own, and has them on the disk within a second.
//
// The loop of a flight in real time must wait neither for the file system nor for the disk, and what it
// recorded must survive a power cut. So it only hands bytes on. The writer's thread writes them and calls
// fdatasync, every half second. It does so, too, for all other files of the directory that have grown, such
// as those of the vehicle, and calls fsync for the directory if a file is new. The thread has no priority: a
// real-time thread does not wait for it.
#pragma once
#include <sys/types.h>

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace karst::core {

class DiskWriter {
 public:
  using File = std::size_t;

  explicit DiskWriter(std::filesystem::path folder);
  ~DiskWriter();
  DiskWriter(const DiskWriter&) = delete;
  DiskWriter& operator=(const DiskWriter&) = delete;

  /// Makes an empty file. Throws InputError.
  File open(const std::filesystem::path& path);
  /// Takes `bytes`, which is empty afterwards. False once a write has failed, or the disk is so slow that
  /// kMaxPending is not written yet: then what comes later is lost.
  bool append(File file, std::string& bytes);
  /// The same without ever waiting: while the thread looks at what there is, the bytes stay where they are,
  /// for the next call.
  bool try_append(File file, std::string& bytes);
  /// A file that is written whole, by the thread, which makes it as well. Otherwise as append().
  bool write_whole(const std::filesystem::path& path, std::string& bytes);
  /// Waits until everything is on the disk, and ends the thread. False if something is not.
  bool finish();

  static constexpr std::size_t kMaxPending = std::size_t{64} << 20;  // bytes

 private:
  struct Pending {
    File file;
    std::string bytes;
    std::filesystem::path whole = {};  // the file's path, if that is all of it
  };
  struct Seen {
    std::uintmax_t size = 0;
    std::int64_t changed_ns = 0;
  };
  bool take(Pending pending);
  void run();
  using FileId = std::pair<dev_t, ino_t>;
  template <class Step>
  void guarded(const Step& step);
  void fail();
  bool write(const std::vector<Pending>& batch, std::set<FileId>& synced);
  static bool write_new(const Pending& pending, std::set<FileId>& synced);
  void sync_others(const std::set<FileId>& synced);
  void sync(const std::filesystem::path& file);
  void sync_folder(const std::filesystem::path& folder);

  const std::filesystem::path folder_;
  std::mutex mutex_;  // of what follows, up to the thread's own
  std::condition_variable wake_;
  std::vector<int> descriptors_;
  std::vector<Pending> pending_;
  std::size_t pending_bytes_ = 0;
  bool failed_ = false, over_ = false;
  std::map<std::filesystem::path, Seen> seen_;  // the thread's own
  std::thread thread_;
};

}  // namespace karst::core
