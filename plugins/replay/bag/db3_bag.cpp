// Bags of ROS 2 in SQLite: a table of topics, and one of messages in CDR.
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "plugins/replay/bag/bag.h"

namespace karst::replay {
namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

std::string text_at(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))) : "";
}

class Db3Bag final : public Bag {
 public:
  explicit Db3Bag(const std::string& path) : path_(path), db_(open(path)) {
    steps_left_ = kMinSteps + kStepsAByte * static_cast<std::int64_t>(std::filesystem::file_size(path));
    sqlite3_progress_handler(db_.get(), kStepsAtOnce, &Db3Bag::is_too_long, this);
    note_if_cut();
    read_topics();
    // By the index of times where there is one; the messages themselves are not sorted, but their numbers.
    order_ = prepare("SELECT rowid, topic_id, timestamp FROM messages ORDER BY timestamp, rowid");
    data_ = prepare("SELECT data FROM messages WHERE rowid = ?");
    if (!order_ || !data_) throw core::InputError(path_, "table messages", sqlite3_errmsg(db_.get()));
  }

  const std::vector<Connection>& connections() const override { return connections_; }
  void select(std::vector<bool> wanted) override { wanted_ = std::move(wanted); }
  const FaultLog& faults() const override { return faults_; }

  core::TimeNs begin() const override {
    // ROS 2 writes this index; without it, all messages would have to be read.
    const auto first =
        prepare("SELECT timestamp FROM messages INDEXED BY timestamp_idx ORDER BY timestamp LIMIT 1");
    return first && sqlite3_step(first.get()) == SQLITE_ROW ? sqlite3_column_int64(first.get(), 0)
                                                            : unknown_begin();
  }

  std::optional<BagMessage> next() override {
    while (!ended_) {
      const int result = sqlite3_step(order_.get());
      ended_ = result == SQLITE_DONE;  // another step would begin anew
      if (ended_) break;
      if (result != SQLITE_ROW) {
        ended_ = !read_in_file_order(result);
        continue;
      }
      const auto row = sqlite3_column_int64(order_.get(), 0), topic = sqlite3_column_int64(order_.get(), 1);
      const core::TimeNs time = sqlite3_column_int64(order_.get(), 2);
      if (in_file_order_ && seen_before_damage(row)) continue;
      if (!in_file_order_ && in_order_.size() < kMaxRemembered) in_order_.push_back(row);
      const auto connection = by_id_.find(topic);
      if (connection == by_id_.end()) {
        faults_.add(place_of(row),
                    "a message of the topic " + std::to_string(topic) + ", which is not described");
        continue;
      }
      if (time < 0) {
        faults_.add(place_of(row), "a message's time is before the year 1970");
        continue;
      }
      if (!wanted_.empty() && (connection->second >= wanted_.size() || !wanted_[connection->second]))
        continue;
      sqlite3_reset(data_.get());
      sqlite3_bind_int64(data_.get(), 1, row);
      if (const int data = sqlite3_step(data_.get()); data != SQLITE_ROW) {
        faults_.add(place_of(row), std::string("cannot be read: ") + reason(data));
        continue;
      }
      const auto* bytes = static_cast<const char*>(sqlite3_column_blob(data_.get(), 0));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(data_.get(), 0));
      return BagMessage{connection->second, time, Bytes(bytes, bytes ? size : 0), 0,
                        static_cast<std::size_t>(row)};
    }
    return std::nullopt;
  }

 private:
  static Database open(const std::string& path) {
    core::check_input(path, core::kMaxDataFileBytes);
    refuse_unclosed(path);
    std::string uri = "file:";
    for (const char c : path) {
      if (c == '?' || c == '#' || c == '%') {
        static constexpr const char* kHex = "0123456789ABCDEF";
        uri += {'%', kHex[(c >> 4) & 15], kHex[c & 15]};
      } else {
        uri += c;
      }
    }
    sqlite3* raw = nullptr;
    const int result = sqlite3_open_v2((uri + "?immutable=1").c_str(), &raw,
                                       SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    Database db(raw, &sqlite3_close);
    if (result != SQLITE_OK) throw core::InputError(path, "", sqlite3_errstr(result));
    // A database that somebody else wrote: no functions of its schema are run, and damage is found. A file
    // with fewer pages than it announces is read as far as it goes only with a writable schema; nothing is
    // written.
    sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, 1 << 28);
    sqlite3_exec(raw, "PRAGMA cell_size_check=1; PRAGMA cache_size=-8000; PRAGMA temp_store=1", nullptr,
                 nullptr, nullptr);
    return db;
  }

  /// What was written last may stand beside a database that was not closed. SQLite would merge both into the
  /// file, which is the user's.
  static void refuse_unclosed(const std::string& path) {
    for (const char* const ending : {"-wal", "-journal"}) {
      std::error_code error;
      const auto size = std::filesystem::file_size(path + ending, error);
      if (!error && size > 0)
        throw core::InputError(path, "",
                               "was not closed: messages of it stand in " + path + ending +
                                   ". Copy both files, and join the copies: sqlite3 COPY.db3 'PRAGMA "
                                   "journal_mode=DELETE; VACUUM'");
    }
  }

  /// The header has the size of a page at byte 16 and the number of pages at byte 28, big-endian
  /// (https://www.sqlite.org/fileformat.html).
  void note_if_cut() {
    std::array<unsigned char, 32> head{};
    core::open_input(path_, core::kMaxDataFileBytes).read(reinterpret_cast<char*>(head.data()), head.size());
    const auto number = [&](std::size_t at, std::size_t bytes) {
      std::uint64_t v = 0;
      for (std::size_t i = at; i < at + bytes; ++i) v = v << 8 | head[i];
      return v;
    };
    const std::uint64_t page_bytes = number(16, 2) == 1 ? 65536 : number(16, 2),
                        announced = page_bytes * number(28, 4), there = std::filesystem::file_size(path_);
    if (there < announced)
      faults_.add("byte " + std::to_string(there),
                  "the file ends here, and its header says " + std::to_string(announced) +
                      " bytes: it is cut, and only what SQLite still finds is read");
  }

  Statement prepare(const char* sql) const {
    sqlite3_stmt* raw = nullptr;
    sqlite3_prepare_v2(db_.get(), sql, -1, &raw, nullptr);
    return {raw, &sqlite3_finalize};
  }

  void read_topics() {
    std::map<std::string, std::string> definitions;  // of bags since ROS 2 Iron
    if (const auto rows =
            prepare("SELECT topic_type, encoded_message_definition, encoding FROM message_definitions"))
      while (sqlite3_step(rows.get()) == SQLITE_ROW)
        if (text_at(rows.get(), 2) == "ros2msg") definitions[text_at(rows.get(), 0)] = text_at(rows.get(), 1);
    const auto rows = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    int result = rows ? SQLITE_ROW : SQLITE_ERROR;
    while (rows && (result = sqlite3_step(rows.get())) == SQLITE_ROW) {
      Connection c;
      c.topic = text_at(rows.get(), 1);
      const std::string type = text_at(rows.get(), 2);
      c.type = plain_type(type);
      c.encoding = text_at(rows.get(), 3) == "cdr" ? Encoding::cdr : Encoding::unknown;
      if (const auto found = definitions.find(type); found != definitions.end()) c.definition = found->second;
      by_id_.emplace(sqlite3_column_int64(rows.get(), 0), connections_.size());
      connections_.push_back(std::move(c));
    }
    if (result != SQLITE_DONE)
      throw core::InputError(path_, "table topics",
                             std::string("is no bag of ROS 2: ") + sqlite3_errmsg(db_.get()));
    if (connections_.empty()) throw core::InputError(path_, "table topics", "holds no topic");
  }

  /// The order of time may lead over damaged pages: reads on by row, without the index. False at the second
  /// damage.
  bool read_in_file_order(int problem) {
    faults_.add(last_row_ == 0 ? "table messages" : place_of(last_row_),
                std::string(reason(problem)) +
                    (in_file_order_ ? "" : ": the other messages are read in the order of the file"));
    if (in_file_order_) return false;
    in_file_order_ = true;
    std::sort(in_order_.begin(), in_order_.end());
    order_ = prepare("SELECT rowid, topic_id, timestamp FROM messages NOT INDEXED ORDER BY rowid");
    return order_ != nullptr;
  }
  bool seen_before_damage(std::int64_t row) {
    last_row_ = row;
    return std::binary_search(in_order_.begin(), in_order_.end(), row);
  }
  static std::string place_of(std::int64_t row) { return "table messages, row " + std::to_string(row); }

  static constexpr std::size_t kMaxRemembered = 10'000'000;

  /// Damaged pages may lead in a circle: reading ends when it has taken more steps of SQLite's machine than
  /// so many bytes can need. A message takes tens of steps, and has tens of bytes.
  static constexpr std::int64_t kMinSteps = 1'000'000, kStepsAByte = 100;
  static constexpr int kStepsAtOnce = 10'000;
  static int is_too_long(void* bag) {
    return (static_cast<Db3Bag*>(bag)->steps_left_ -= kStepsAtOnce) < 0 ? 1 : 0;
  }
  static const char* reason(int result) {
    return result == SQLITE_INTERRUPT ? "its pages lead in a circle" : sqlite3_errstr(result);
  }

  std::string path_;
  std::int64_t steps_left_ = 0;
  Database db_;
  Statement order_{nullptr, &sqlite3_finalize}, data_{nullptr, &sqlite3_finalize};
  std::vector<Connection> connections_;
  std::map<std::int64_t, std::size_t> by_id_;
  std::vector<bool> wanted_;
  std::vector<std::int64_t> in_order_;  // rows that were read by time
  bool in_file_order_ = false, ended_ = false;
  std::int64_t last_row_ = 0;
  FaultLog faults_;
};

}  // namespace

std::unique_ptr<Bag> open_db3(const std::string& path) { return std::make_unique<Db3Bag>(path); }

}  // namespace karst::replay
