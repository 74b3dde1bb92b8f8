#include "sdk/campaign/store/store.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "tests/unit/campaign/store/store_fixture.h"

namespace karst::campaign {
namespace {

std::vector<TrialKey> all_trials(const StoreHead& head) {
  std::vector<TrialKey> keys;
  for (std::size_t k = 0; k < head.contestants.size(); ++k)
    for (std::size_t c = 0; c < head.caves.size(); ++c)
      for (const std::int64_t seed : head.seeds) keys.emplace_back(k, c, seed);
  return keys;
}

void add(Store& store, const TrialKey& key) {
  store.add(trial_of(std::get<0>(key), std::get<1>(key), std::get<2>(key)));
}

fs::path full_store(const fs::path& folder) {
  const fs::path file = folder / "campaign.sqlite";
  Store store = Store::create(file, small_head());
  for (const TrialKey& key : all_trials(small_head())) add(store, key);
  return file;
}

void overwrite(const fs::path& file, std::size_t at, const std::string& bytes) {
  std::fstream f(file, std::ios::binary | std::ios::in | std::ios::out);
  f.seekp(static_cast<std::streamoff>(at));
  f << bytes;
}

TEST(Store, GivesBackWhatItWasGiven) {
  const fs::path file = full_store(quick_folder("back"));
  const CampaignResults r = read_results(file.parent_path());  // the folder is enough
  EXPECT_EQ(r.name, "small");
  EXPECT_EQ(r.horizon_s, 300);
  ASSERT_EQ(r.contestants.size(), 3u);
  EXPECT_EQ(r.contestants[1].name, "far");
  ASSERT_EQ(r.caves.size(), 2u);
  EXPECT_EQ(r.caves[1].hash, "abc");
  const std::vector<TrialKey> keys = all_trials(small_head());
  const std::vector<TrialExtras> extras = read_with_extras(file).extras;
  ASSERT_EQ(r.trials.size(), keys.size());
  ASSERT_EQ(extras.size(), keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto& [k, c, seed] = keys[i];
    const StoredTrial wanted = trial_of(k, c, seed);
    const TrialResult& t = r.trials[i];
    EXPECT_EQ(std::tuple(t.contestant, t.cave, t.seed), std::tuple(k, c, seed));
    EXPECT_EQ(t.failed, seed == 9);
    EXPECT_EQ(t.reason, wanted.result.reason);
    EXPECT_EQ(t.ended, wanted.result.ended);
    EXPECT_EQ(t.run_dir, (file.parent_path() / wanted.result.run_dir).string());
    ASSERT_EQ(t.figures.size(), wanted.result.figures.size());
    for (std::size_t f = 0; f < t.figures.size(); ++f) {
      if (std::isnan(wanted.result.figures[f]))
        EXPECT_TRUE(std::isnan(t.figures[f]));
      else
        EXPECT_EQ(t.figures[f], wanted.result.figures[f]);
    }
    ASSERT_EQ(t.curve.size(), 20u);
    EXPECT_EQ(t.curve[7].time_s, 14);
    EXPECT_EQ(t.curve[7].coverage, 0.35);
    EXPECT_EQ(extras[i].mission_hash, wanted.mission_hash);
    EXPECT_EQ(extras[i].timing.trial_s, wanted.timing.trial_s);
  }
}

RC_GTEST_PROP(Store, HoldsTheSameWhateverTheOrderAndHoweverOftenItWasInterrupted, ()) {
  static const std::string undisturbed = dump(full_store(quick_folder("undisturbed")));
  std::vector<TrialKey> keys = all_trials(small_head());
  for (std::size_t i = keys.size(); i > 1; --i)
    std::swap(keys[i - 1], keys[*rc::gen::inRange<std::size_t>(0, i)]);
  const fs::path file = quick_folder("shuffled") / "campaign.sqlite";
  { Store::create(file, small_head()); }
  std::size_t at = 0;
  while (at < keys.size()) {  // opened anew after some, with the last one done twice
    Store store = Store::open(file);
    RC_ASSERT(store.finished().size() == at);
    if (at > 0) add(store, keys[at - 1]);
    for (std::size_t n = *rc::gen::inRange<std::size_t>(1, 9); n > 0 && at < keys.size(); --n)
      add(store, keys[at++]);
  }
  RC_ASSERT(dump(file) == undisturbed);
}

TEST(Store, AppendedSeedsAndContestantsLeaveIdsAsTheyWere) {
  StoreHead small = small_head();
  small.contestants.pop_back();
  small.seeds.pop_back();
  const fs::path file = quick_folder("appended") / "campaign.sqlite";
  Store store = Store::create(file, small);
  for (const TrialKey& key : all_trials(small)) add(store, key);
  store.extend(small_head());
  for (const TrialKey& key : all_trials(small_head()))
    if (!store.finished().contains(key)) add(store, key);
  EXPECT_EQ(dump(file), dump(full_store(quick_folder("at_once"))));
}

TEST(Store, RefusesAnythingButAppending) {
  const fs::path file = full_store(quick_folder("reordered"));
  Store store = Store::open(file);
  StoreHead head = small_head();
  std::swap(head.contestants[0], head.contestants[1]);
  EXPECT_TRUE(says(error_of([&] { store.extend(head); }), "contestants"));
  head = small_head();
  head.seeds.erase(head.seeds.begin());
  EXPECT_TRUE(says(error_of([&] { store.extend(head); }), "seeds"));
}

TEST(Store, DoesNotGrowToWhereIdsOfTrialsRunIntoEachOther) {
  StoreHead head = small_head();
  Store store = Store::create(quick_folder("caves") / "campaign.sqlite", head);
  while (head.caves.size() < 1000)
    head.caves.push_back({"cave" + std::to_string(head.caves.size()), "x.info", "", "", "abc"});
  EXPECT_TRUE(says(error_of([&] { store.extend(head); }), "at most 999 caves"));
}

TEST(Store, KeepsADescriptionOfACaveWhenTheCampaignGrows) {
  const fs::path file = full_store(quick_folder("described"));
  Store store = Store::open(file);
  store.describe_cave(1, R"({"volume": 3})");
  store.extend(small_head());
  EXPECT_EQ(read_results(file).caves[1].description, R"({"volume": 3})");
  EXPECT_EQ(read_results(file).caves[0].description, "");
}

TEST(Store, RefusesATrialThatIsNoneOfTheCampaigns) {
  const fs::path file = full_store(quick_folder("foreign_trial"));
  Store store = Store::open(file);
  EXPECT_NE(error_of([&] { store.add(trial_of(0, 0, 77)); }), "");
}

TEST(Store, NamesWhatAFileIsInsteadOfAStore) {
  const fs::path dir = fresh_folder("foreign");
  std::ofstream(dir / "text.sqlite") << std::string(5000, 'x');
  std::ofstream(dir / "empty.sqlite");
  sqlite3* other = nullptr;
  sqlite3_open((dir / "other.sqlite").c_str(), &other);
  sqlite3_exec(other, "CREATE TABLE trial(id)", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  EXPECT_TRUE(says(error_of([&] { read_results(dir / "text.sqlite"); }), "is no SQLite file"));
  EXPECT_TRUE(says(error_of([&] { read_results(dir / "empty.sqlite"); }), "is no store of a karst campaign"));
  EXPECT_TRUE(says(error_of([&] { Store::open(dir / "other.sqlite"); }), "is no store of a karst campaign"));
  EXPECT_TRUE(says(error_of([&] { Store::open(dir / "nowhere.sqlite"); }), "no such store"));
  EXPECT_TRUE(says(error_of([&] { Store::create(dir / "text.sqlite", small_head()); }), "is there already"));
}

TEST(Store, OfALaterVersionIsRefusedAsSuch) {
  const fs::path file = full_store(quick_folder("later"));
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  sqlite3_exec(db, "PRAGMA user_version = 7", nullptr, nullptr, nullptr);
  sqlite3_close(db);
  EXPECT_TRUE(says(error_of([&] { read_results(file); }), "version 7, this karst reads version 1"));
}

TEST(Store, WhoseDefinitionOrHorizonIsDamagedSaysSo) {
  for (const auto& [change, complaint] :
       {std::pair("UPDATE campaign SET value = 'x {' WHERE key = 'definition'",
                  "campaign.definition: line 1: unmatched {"),
        std::pair("UPDATE campaign SET value = '-5' WHERE key = 'horizon_s'",
                  "campaign.horizon_s: expected seconds, got -5")}) {
    const fs::path file = full_store(quick_folder("head"));
    sqlite3* db = nullptr;
    sqlite3_open(file.c_str(), &db);
    ASSERT_EQ(sqlite3_exec(db, change, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(db);
    const std::string error = error_of([&] { read_results(file); });
    EXPECT_TRUE(says(error, complaint) && says(error, file.string())) << error;
  }
}

TEST(Store, ReadWhileACampaignFliesGivesEachTrialItsOwnTiming) {
  const fs::path file = quick_folder("flying") / "campaign.sqlite";
  Store store = Store::create(file, small_head());
  std::vector<TrialKey> keys = all_trials(small_head());
  std::reverse(keys.begin(), keys.end());  // each comes in front of those there are
  std::thread campaign([&] {
    for (const TrialKey& key : keys) add(store, key);
  });
  for (std::size_t seen = 0; seen < keys.size();) {
    const auto [results, extras] = read_with_extras(file);
    seen = results.trials.size();
    EXPECT_EQ(extras.size(), seen);
    for (std::size_t i = 0; i < std::min(seen, extras.size()); ++i) {
      const TrialResult& t = results.trials[i];
      EXPECT_EQ(extras[i].mission_hash, trial_of(t.contestant, t.cave, t.seed).mission_hash);
    }
  }
  campaign.join();
}

TEST(Store, ThatLacksAFigureIsReadWithoutAndNotWritten) {
  const fs::path file = full_store(quick_folder("lacking"));
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  ASSERT_EQ(
      sqlite3_exec(db, "DROP VIEW result; ALTER TABLE trial DROP COLUMN coverage", nullptr, nullptr, nullptr),
      SQLITE_OK);
  sqlite3_close(db);
  const auto coverage = static_cast<std::size_t>(evaluation::metric_index("coverage"));
  EXPECT_TRUE(std::isnan(read_results(file).trials[0].figures[coverage]));
  EXPECT_TRUE(says(error_of([&] { Store::open(file); }), "trial.coverage"));
}

// An earlier karst did not tell how a trial ended.
TEST(Store, ThatLacksTheEndingsIsReadAndWrittenWithout) {
  const fs::path file = full_store(quick_folder("no_endings"));
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  ASSERT_EQ(
      sqlite3_exec(db, "DROP VIEW result; ALTER TABLE trial DROP COLUMN ended", nullptr, nullptr, nullptr),
      SQLITE_OK);
  sqlite3_close(db);
  Store store = Store::open(file);
  store.add(trial_of(0, 0, 1));
  const CampaignResults r = read_results(file);
  EXPECT_EQ(r.trials.size(), all_trials(small_head()).size());
  EXPECT_EQ(r.trials[0].ended, "");
  EXPECT_EQ(r.trials[0].reason, trial_of(0, 0, 1).result.reason);
  EXPECT_EQ(r.trials[0].figures[0], trial_of(0, 0, 1).result.figures[0]);
}

RC_GTEST_PROP(Store, ThatIsDamagedIsAnErrorOrReadButNeverACrash, ()) {
  static const fs::path whole = full_store(quick_folder("whole"));
  const auto size = fs::file_size(whole);
  const fs::path file = quick_folder("damaged") / "campaign.sqlite";
  fs::copy_file(whole, file);
  for (int i = *rc::gen::inRange(1, 6); i > 0; --i) {
    const auto junk = *rc::gen::container<std::string>(64, rc::gen::arbitrary<char>());
    overwrite(file, *rc::gen::inRange<std::size_t>(0, size - 64), junk);
  }
  if (*rc::gen::inRange(0, 3) == 0) fs::resize_file(file, *rc::gen::inRange<std::uintmax_t>(0, size));
  for (const std::string& e : {error_of([&] { read_results(file); }), error_of([&] { Store::open(file); })})
    RC_ASSERT(e.empty() || says(e, "campaign.sqlite"));
}

TEST(Store, WithAPageOfZerosIsCalledDamaged) {
  const fs::path file = full_store(quick_folder("zeros"));
  overwrite(file, 4096 * 3, std::string(4096, '\0'));
  EXPECT_TRUE(says(error_of([&] { read_results(file); }), "damaged"));
}

TEST(Store, LockedByAnotherProgramIsNamedAndLosesNothing) {
  const fs::path file = full_store(quick_folder("locked"));
  const std::string before = dump(file);
  Store store = Store::open(file, 0.1);
  sqlite3* other = nullptr;
  sqlite3_open(file.c_str(), &other);
  sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr);
  EXPECT_TRUE(says(error_of([&] { store.add(trial_of(0, 0, 1)); }), "is locked by another program"));
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  store.add(trial_of(0, 0, 1));
  EXPECT_EQ(dump(file), before);
}

/// A file system of a few pages, gone at the end.
struct SmallDisk {
  explicit SmallDisk(const fs::path& at) : path(at) {
    fs::create_directories(path);
    mounted = mount("tmpfs", path.c_str(), "tmpfs", 0, "size=192k") == 0;
  }
  ~SmallDisk() {
    if (mounted) umount2(path.c_str(), MNT_DETACH);
  }
  fs::path path;
  bool mounted = false;
};

TEST(Store, OnAFullDiskSaysSoAndLosesNothing) {
  const SmallDisk disk(fresh_folder("small_disk") / "disk");
  if (!disk.mounted) GTEST_SKIP() << "skipped: mounting a small tmpfs takes root: " << std::strerror(errno);
  const fs::path file = disk.path / "campaign.sqlite";
  StoreHead head = small_head();
  for (std::int64_t seed = 10; seed < 300; ++seed) head.seeds.push_back(seed);
  Store store = Store::create(file, head);
  std::size_t stored = 0;
  std::string error;
  for (const TrialKey& key : all_trials(head)) {
    error = error_of([&] { add(store, key); });
    if (!error.empty()) break;
    ++stored;
  }
  EXPECT_TRUE(says(error, "the disk is full; what was stored before is there")) << error;
  EXPECT_GT(stored, 10u);
  EXPECT_EQ(read_results(file).trials.size(), stored);
  ASSERT_EQ(mount("tmpfs", disk.path.c_str(), "tmpfs", MS_REMOUNT, "size=8m"), 0);
  for (const TrialKey& key : all_trials(head)) add(store, key);
  EXPECT_EQ(read_results(file).trials.size(), all_trials(head).size());
}

/// The folders in memory go with the program.
class NoTrace : public testing::Environment {
  void TearDown() override { fs::remove_all(quick_folder("x").parent_path().parent_path().parent_path()); }
};
const auto* const no_trace = testing::AddGlobalTestEnvironment(new NoTrace);

TEST(Store, TrialsAddedAtOnceAreThoseAddedOneByOne) {
  const fs::path dir = fresh_folder("at_once");
  const std::vector<StoredTrial> trials = {trial_of(0, 0, 1), trial_of(2, 1, 9), trial_of(1, 0, 2)};
  Store one_by_one = Store::create(dir / "a.sqlite", small_head()),
        at_once = Store::create(dir / "b.sqlite", small_head());
  for (const StoredTrial& t : trials) one_by_one.add(t);
  at_once.add(trials);
  EXPECT_EQ(dump(dir / "a.sqlite"), dump(dir / "b.sqlite"));
}

TEST(Store, OfTrialsAddedAtOnceAllAreThereOrNone) {
  const fs::path dir = fresh_folder("all_or_none");
  Store store = Store::create(dir / "a.sqlite", small_head());
  StoredTrial strange = trial_of(0, 0, 1);
  strange.result.seed = 4711;  // not of this campaign
  EXPECT_NE(error_of([&] { store.add(std::vector<StoredTrial>{trial_of(0, 0, 2), strange}); }), "");
  EXPECT_TRUE(store.finished().empty());
}

}  // namespace
}  // namespace karst::campaign
