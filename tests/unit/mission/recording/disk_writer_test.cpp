#include "core_stack/mission/recording/disk_writer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <mutex>
#include <new>
#include <set>

#include "core_stack/common/error.h"
#include "core_stack/mission/recording/recorder.h"

namespace {

std::atomic<bool> no_memory = false;
std::mutex sync_mutex;  // of what follows
std::set<std::string> synced_folders, synced_again;

std::string path_of(int descriptor) {
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor)).string();
}

}  // namespace

// Instead of those of the C library.
extern "C" int fdatasync(int descriptor) {
  if (no_memory) throw std::bad_alloc();
  struct stat is {};
  // The writer's own files are open for writing.
  if (fstat(descriptor, &is) == 0 && is.st_size > 0 && (fcntl(descriptor, F_GETFL) & O_ACCMODE) == O_RDONLY) {
    const std::lock_guard lock(sync_mutex);
    synced_again.insert(path_of(descriptor));
  }
  return static_cast<int>(syscall(SYS_fdatasync, descriptor));
}
extern "C" int fsync(int descriptor) {
  const std::lock_guard lock(sync_mutex);
  synced_folders.insert(path_of(descriptor));
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

namespace karst::core {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& name) {
  const fs::path dir = fs::path(KARST_BINARY_DIR) / "test_runs" / name;
  fs::remove_all(dir);
  fs::create_directories(dir);
  return dir;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(DiskWriter, WritesWhatItWasGivenInOrder) {
  const fs::path dir = folder_of("disk_writer");
  std::string expected_a, expected_b;
  {
    DiskWriter disk(dir);
    const auto a = disk.open(dir / "a"), b = disk.open(dir / "b");
    std::string pending;
    for (int i = 0; i < 1000; ++i) {
      pending += std::to_string(i) + ",";
      expected_a += std::to_string(i) + ",";
      EXPECT_TRUE(disk.try_append(a, pending)) << "what it does not take stays in `pending`";
      std::string other = "x";
      expected_b += other;
      EXPECT_TRUE(disk.append(b, other));
      EXPECT_TRUE(other.empty());
    }
    EXPECT_TRUE(disk.append(a, pending));
    EXPECT_TRUE(disk.finish());
  }
  EXPECT_EQ(content_of(dir / "a"), expected_a);
  EXPECT_EQ(content_of(dir / "b"), expected_b);
}

TEST(DiskWriter, SaysThatTheDiskIsFullAndWritesTheOtherFiles) {
  const fs::path dir = folder_of("disk_writer_full");
  DiskWriter disk(dir);
  const auto full = disk.open("/dev/full"), good = disk.open(dir / "good");
  std::string one = "one", two = "two";
  disk.append(full, one);
  disk.append(good, two);
  EXPECT_FALSE(disk.finish());
  EXPECT_EQ(content_of(dir / "good"), "two");
  std::string more = "more";
  EXPECT_FALSE(disk.append(good, more));
  EXPECT_TRUE(more.empty()) << "what is lost needs no memory";
}

TEST(DiskWriter, WritesWholeFilesBesideThoseThatGrow) {
  const fs::path dir = folder_of("disk_writer_whole");
  DiskWriter disk(dir);
  const auto grows = disk.open(dir / "grows");
  std::string one = "one", two = "two", three(300'000, 'x'), lost = "lost";
  EXPECT_TRUE(disk.append(grows, one));
  EXPECT_TRUE(disk.write_whole(dir / "whole", three));
  EXPECT_TRUE(three.empty());
  EXPECT_TRUE(disk.append(grows, two));
  disk.write_whole(dir / "none" / "such", lost);
  EXPECT_FALSE(disk.finish()) << "a file that cannot be made shows at the end";
  EXPECT_EQ(content_of(dir / "grows"), "onetwo");
  EXPECT_EQ(content_of(dir / "whole"), std::string(300'000, 'x'));
}

TEST(DiskWriter, ABacklogDoesNotGrowWithoutBound) {
  const fs::path dir = folder_of("disk_writer_backlog");
  DiskWriter disk(dir);
  const auto file = disk.open(dir / "a");
  std::string huge(DiskWriter::kMaxPending + 1, 'x');
  EXPECT_FALSE(disk.append(file, huge));
  EXPECT_TRUE(huge.empty());
}

TEST(DiskWriter, AFileThatCannotBeMadeIsAnError) {
  const fs::path dir = folder_of("disk_writer_error");
  DiskWriter disk(dir);
  EXPECT_THROW(disk.open(dir / "no" / "such"), InputError);
}

TEST(DiskWriter, WhatItsThreadThrowsEndsTheRecordAndNotTheProcess) {
  const fs::path dir = folder_of("disk_writer_throws");
  DiskWriter disk(dir);
  const auto file = disk.open(dir / "a");
  no_memory = true;
  std::string bytes = "some";
  disk.append(file, bytes);
  EXPECT_FALSE(disk.finish());
  no_memory = false;
}

TEST(DiskWriter, AFileThatItHasWrittenIsSyncedOnceAndTheFoldersEntryToo) {
  const fs::path dir = folder_of("disk_writer_syncs");
  {
    DiskWriter disk(dir / "");
    const auto file = disk.open(dir / "a");
    std::string bytes = "some";
    disk.append(file, bytes);
    std::ofstream(dir / "of_the_vehicle") << "more";
    EXPECT_TRUE(disk.finish());
  }
  const std::lock_guard lock(sync_mutex);
  const fs::path real = fs::canonical(dir);
  EXPECT_FALSE(synced_again.contains((real / "a").string()));
  EXPECT_TRUE(synced_again.contains((real / "of_the_vehicle").string()));
  EXPECT_TRUE(synced_folders.contains(real.parent_path().string()));
}

TEST(Recorder, NoFileIsMadeInFlightAndNoneStaysThatIsEmpty) {
  const fs::path dir = folder_of("recorder_no_file_in_flight");
  const auto files = [&] {
    std::set<std::string> names;
    for (const auto& at : fs::directory_iterator(dir)) names.insert(at.path().filename().string());
    return names;
  };
  Recorder recorder(dir, Durability::survives_a_power_cut);
  const auto before = files();
  EXPECT_TRUE(before.contains("frames.csv"));
  recorder.unsurveyed(kSecond, 1);
  EXPECT_TRUE(recorder.flush());
  EXPECT_EQ(files(), before);
  EXPECT_TRUE(recorder.close());
  EXPECT_TRUE(files().contains("unsurveyed.csv"));
  EXPECT_FALSE(files().contains("frames.csv"));
}

TEST(Recorder, WritesTheSameBytesWhateverItIsToSurvive) {
  std::vector<fs::path> folders;
  for (const auto durability : {Durability::survives_a_crash, Durability::survives_a_power_cut}) {
    folders.push_back(folder_of("recorder_durability_" + std::to_string(folders.size())));
    Recorder recorder(folders.back(), durability);
    for (int i = 1; i < 200; ++i) {
      const TimeNs t = i * 100 * kMillisecond;
      recorder.write(t, event::Log{"line " + std::to_string(i)});
      recorder.pose({.stamp = t});
      Telemetry row;
      row.stamp = t;
      recorder.telemetry(row);
      recorder.unsurveyed(t, i);
      recorder.decision_cost(t, 1, 2);
      recorder.map_changes(t, std::vector<CellChange>{{{i, 0, 0}, Cell::unknown, Cell::occupied}});
      EXPECT_TRUE(recorder.flush());
    }
    EXPECT_TRUE(recorder.close());
  }
  for (const char* name : {"events.jsonl", "trajectory.tum", "telemetry.csv", "localization.csv",
                           "map_growth.bin", "decisions.csv", "unsurveyed.csv"}) {
    EXPECT_GT(fs::file_size(folders[0] / name), 50u) << name;
    EXPECT_EQ(content_of(folders[0] / name), content_of(folders[1] / name)) << name;
  }
  EXPECT_FALSE(fs::exists(folders[0] / "map_cells.bin"));
  EXPECT_EQ(fs::file_size(folders[1] / "map_cells.bin"), 199u * 16);
}

}  // namespace
}  // namespace karst::core
