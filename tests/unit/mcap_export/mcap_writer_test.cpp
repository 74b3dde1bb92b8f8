// The file's structure, against the specification: check sums, offsets, indexes and counts.
#include "sdk/mcap_export/mcap_writer.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/unit/mcap_export/mcap_records_read.h"

namespace karst::mcap {
namespace {

using test::Cursor;
using test::McapRecord;

/// CRC-32 (IEEE 802.3), bit by bit.
std::uint32_t crc32_of(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

ChannelInfo channel(const std::string& topic, const std::string& schema = "test/msg/A") {
  return {topic, "cdr", schema, "ros2msg", "int32 x\n", {{"key", "value"}}};
}

/// Two topics, four chunks: a chunk ends with the message that reaches 300 bytes.
class WrittenMcap : public testing::Test {
 protected:
  WrittenMcap() {
    McapWriter writer(out_, {.profile = "ros2", .library = "test", .chunk_bytes = 300});
    const ChannelId a = writer.add_channel(channel("/a")), b = writer.add_channel(channel("/b"));
    writer.write(a, 100, std::string(100, 'a'));
    writer.write(b, 200, std::string(10, 'b'));
    writer.write(a, 300, std::string(400, 'c'));
    writer.write(b, 250, std::string(300, 'd'));  // alone in its chunk, and late
    writer.write(a, 400, "e");
    writer.metadata("made", {{"by", "test"}, {"at", "noon"}});
    writer.finish();
    file_ = out_.str();
    records_ = test::file_records(file_);
    EXPECT_EQ(writer.bytes(), file_.size());
    EXPECT_EQ(writer.messages(), 5u);
  }
  std::vector<McapRecord> of(int opcode) const {
    std::vector<McapRecord> out;
    for (const McapRecord& r : records_)
      if (r.opcode == opcode) out.push_back(r);
    return out;
  }
  const McapRecord& at(std::uint64_t offset) const {
    for (const McapRecord& r : records_)
      if (r.offset == offset) return r;
    throw std::runtime_error("no record begins there");
  }

  std::ostringstream out_;
  std::string file_;
  std::vector<McapRecord> records_;
};

TEST_F(WrittenMcap, BeginsAndEndsWithTheMagicAndNamesItsProfile) {
  const std::string magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(file_.substr(0, 8), magic);
  EXPECT_EQ(file_.substr(file_.size() - 8), magic);
  ASSERT_EQ(records_.front().opcode, 0x01);
  Cursor header(records_.front().content);
  EXPECT_EQ(header.text(), "ros2");
  EXPECT_EQ(header.text(), "test");
  EXPECT_EQ(records_.back().opcode, 0x02);
}

TEST_F(WrittenMcap, ChecksumsAreThoseOfTheBytes) {
  ASSERT_EQ(of(0x06).size(), 4u);
  for (const McapRecord& r : of(0x06)) {
    const test::McapChunk chunk = test::chunk_of(r.content);
    EXPECT_EQ(chunk.crc, crc32_of(chunk.records));
  }
  const McapRecord end = of(0x0F).at(0);
  EXPECT_EQ(Cursor(end.content).number<std::uint32_t>(), crc32_of(file_.substr(0, end.offset)));
  const McapRecord footer = records_.back();
  Cursor c(footer.content);
  const auto summary_start = c.number<std::uint64_t>();
  c.number<std::uint64_t>();
  const std::size_t crc_at = footer.offset + 9 + 16;
  EXPECT_EQ(c.number<std::uint32_t>(), crc32_of(file_.substr(summary_start, crc_at - summary_start)));
}

TEST_F(WrittenMcap, IndexesLeadToChunksAndMessages) {
  const auto indexes = of(0x08);
  ASSERT_EQ(indexes.size(), 4u);
  std::size_t found = 0;
  for (const McapRecord& r : indexes) {
    Cursor c(r.content);
    const auto begin = c.number<std::uint64_t>(), end = c.number<std::uint64_t>();
    const McapRecord& chunk_record = at(c.number<std::uint64_t>());
    ASSERT_EQ(chunk_record.opcode, 0x06);
    EXPECT_EQ(c.number<std::uint64_t>(), chunk_record.length);
    const test::McapChunk chunk = test::chunk_of(chunk_record.content);
    EXPECT_EQ(chunk.begin_ns, begin);
    EXPECT_EQ(chunk.end_ns, end);
    std::uint64_t index_bytes = 0;
    for (auto left = c.number<std::uint32_t>() / 10; left > 0; --left) {
      const auto channel = c.number<std::uint16_t>();
      const McapRecord& index = at(c.number<std::uint64_t>());
      ASSERT_EQ(index.opcode, 0x07);
      index_bytes += index.length;
      Cursor entries(index.content);
      EXPECT_EQ(entries.number<std::uint16_t>(), channel);
      for (auto more = entries.number<std::uint32_t>() / 16; more > 0; --more) {
        const auto time = entries.number<std::uint64_t>();
        const std::string_view rest = std::string_view(chunk.records).substr(entries.number<std::uint64_t>());
        Cursor message(rest);
        EXPECT_EQ(message.number<std::uint8_t>(), 0x05);
        message.number<std::uint64_t>();
        EXPECT_EQ(message.number<std::uint16_t>(), channel);
        message.number<std::uint32_t>();
        EXPECT_EQ(message.number<std::uint64_t>(), time);
        EXPECT_TRUE(time >= begin && time <= end);
        ++found;
      }
    }
    EXPECT_EQ(c.number<std::uint64_t>(), index_bytes);
    EXPECT_EQ(c.text(), "zstd");
    c.number<std::uint64_t>();
    EXPECT_EQ(c.number<std::uint64_t>(), chunk.records.size());
    EXPECT_TRUE(c.empty());
  }
  EXPECT_EQ(found, 5u);
}

TEST_F(WrittenMcap, SummaryCountsAndItsGroupsAreWhereTheOffsetsSay) {
  Cursor c(of(0x0B).at(0).content);
  EXPECT_EQ(c.number<std::uint64_t>(), 5u);
  EXPECT_EQ(c.number<std::uint16_t>(), 1u);  // both topics are of one schema
  EXPECT_EQ(c.number<std::uint32_t>(), 2u);
  EXPECT_EQ(c.number<std::uint32_t>(), 0u);
  EXPECT_EQ(c.number<std::uint32_t>(), 1u);
  EXPECT_EQ(c.number<std::uint32_t>(), 4u);
  EXPECT_EQ(c.number<std::uint64_t>(), 100u);
  EXPECT_EQ(c.number<std::uint64_t>(), 400u);
  EXPECT_EQ(c.number<std::uint32_t>(), 20u);
  EXPECT_EQ(c.number<std::uint16_t>(), 0u);
  EXPECT_EQ(c.number<std::uint64_t>(), 3u);
  EXPECT_EQ(c.number<std::uint16_t>(), 1u);
  EXPECT_EQ(c.number<std::uint64_t>(), 2u);
  const auto offsets = of(0x0E);
  EXPECT_EQ(offsets.size(), 5u);
  for (const McapRecord& r : offsets) {
    Cursor offset(r.content);
    const int opcode = offset.number<std::uint8_t>();
    const auto start = offset.number<std::uint64_t>(), length = offset.number<std::uint64_t>();
    std::uint64_t all = 0;
    for (const McapRecord& inside : of(opcode)) all += inside.offset >= start ? inside.length : 0;
    EXPECT_EQ(at(start).opcode, opcode);
    EXPECT_EQ(all, length);
  }
}

TEST_F(WrittenMcap, MetadataIsIndexed) {
  Cursor index(of(0x0D).at(0).content);
  const McapRecord& metadata = at(index.number<std::uint64_t>());
  EXPECT_EQ(metadata.opcode, 0x0C);
  EXPECT_EQ(index.number<std::uint64_t>(), metadata.length);
  EXPECT_EQ(index.text(), "made");
  Cursor c(metadata.content);
  EXPECT_EQ(c.text(), "made");
  c.number<std::uint32_t>();
  EXPECT_EQ(c.text(), "at");
  EXPECT_EQ(c.text(), "noon");
}

TEST_F(WrittenMcap, SchemaAndChannelStandBeforeTheFirstMessageAndInTheSummary) {
  const auto messages = test::messages_of(file_);  // throws if a message came before its channel
  ASSERT_EQ(messages.size(), 5u);
  EXPECT_EQ(messages[3].topic, "/b");
  EXPECT_EQ(messages[3].data, std::string(300, 'd'));
  EXPECT_EQ(messages[4].sequence, 2u);  // the third of its channel
  EXPECT_EQ(of(0x03).size(), 1u);       // outside of the chunks
  EXPECT_EQ(of(0x04).size(), 2u);
}

TEST(McapWriter, AFileWithoutMessagesIsWhole) {
  std::ostringstream out;
  McapWriter writer(out, {.profile = "ros2", .library = "test"});
  writer.finish();
  const std::string file = out.str();
  const auto records = test::file_records(file);
  EXPECT_EQ(records.front().opcode, 0x01);
  EXPECT_EQ(records.back().opcode, 0x02);
  EXPECT_TRUE(test::messages_of(file).empty());
}

TEST(McapWriter, SaysThatItsStreamFailed) {
  std::ostringstream out;
  McapWriter writer(out, {.profile = "ros2", .library = "test", .chunk_bytes = 1});
  EXPECT_TRUE(writer.good());
  out.setstate(std::ios::badbit);
  writer.write(writer.add_channel(channel("/a")), 1, "x");
  EXPECT_FALSE(writer.good());
}

}  // namespace
}  // namespace karst::mcap
