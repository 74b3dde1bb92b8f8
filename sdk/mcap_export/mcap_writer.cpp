#include "sdk/mcap_export/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sdk/mcap_export/mcap_records.h"

namespace karst::mcap {
namespace {

using core::append_bytes;

constexpr int kZstdLevel = 3;

std::uint32_t crc_of(std::string_view bytes, unsigned long before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string compressed(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

}  // namespace

McapWriter::McapWriter(std::ostream& out, WriterOptions options) : out_(out), options_(std::move(options)) {
  std::string header;
  append_text(header, options_.profile);
  append_text(header, options_.library);
  put(kMagic);
  put(record(Opcode::header, header));
}

void McapWriter::put(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  crc_ = crc_of(bytes, crc_);
  position_ += bytes.size();
}

ChannelId McapWriter::add_channel(const ChannelInfo& info) {
  if (channels_.size() == std::numeric_limits<ChannelId>::max())
    throw std::length_error("MCAP: more than 65535 channels");
  const auto [found, is_new] =
      schema_of_name_.try_emplace(info.schema_name, static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new) {  // numbers of schemas begin with 1: 0 is none
    std::string schema;
    append_bytes(schema, found->second);
    append_text(schema, info.schema_name);
    append_text(schema, info.schema_encoding);
    append_text(schema, info.schema);
    schemas_.push_back({record(Opcode::schema, schema)});
  }
  const auto id = static_cast<ChannelId>(channels_.size());
  std::string channel;
  append_bytes(channel, id);
  append_bytes(channel, found->second);
  append_text(channel, info.topic);
  append_text(channel, info.message_encoding);
  append_map(channel, info.metadata);
  channels_.push_back({record(Opcode::channel, channel), found->second});
  return id;
}

void McapWriter::write(ChannelId id, std::uint64_t time_ns, std::string_view message) {
  Channel& channel = channels_.at(id);
  if (channel.messages == 0) {  // they stand before the channel's first message
    Schema& schema = schemas_[channel.schema - 1];
    if (!std::exchange(schema.written, true)) chunk_ += schema.record;
    chunk_ += channel.record;
  }
  chunk_begin_ns_ = chunk_index_.empty() ? time_ns : std::min(chunk_begin_ns_, time_ns);
  chunk_end_ns_ = chunk_index_.empty() ? time_ns : std::max(chunk_end_ns_, time_ns);
  begin_ns_ = messages_ == 0 ? time_ns : std::min(begin_ns_, time_ns);
  end_ns_ = std::max(end_ns_, time_ns);
  chunk_index_[id].push_back({time_ns, chunk_.size()});

  append_bytes(chunk_, static_cast<std::uint8_t>(Opcode::message));
  append_bytes(chunk_, std::uint64_t{2 + 4 + 8 + 8} + message.size());
  append_bytes(chunk_, id);
  append_bytes(chunk_, static_cast<std::uint32_t>(channel.messages));  // sequence
  append_bytes(chunk_, time_ns);                                       // logged
  append_bytes(chunk_, time_ns);                                       // published
  chunk_ += message;
  ++channel.messages;
  ++messages_;
  if (chunk_.size() >= options_.chunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::string records = compressed(chunk_);
  const std::uint64_t chunk_start = position_;
  std::string chunk;
  append_bytes(chunk, chunk_begin_ns_);
  append_bytes(chunk, chunk_end_ns_);
  append_bytes(chunk, std::uint64_t{chunk_.size()});
  append_bytes(chunk, crc_of(chunk_));
  append_text(chunk, "zstd");
  append_bytes(chunk, std::uint64_t{records.size()});
  chunk += records;
  put(record(Opcode::chunk, chunk));
  const std::uint64_t index_start = position_;

  std::string offsets;  // of the message indexes, by channel
  for (const auto& [channel, entries] : chunk_index_) {
    append_bytes(offsets, channel);
    append_bytes(offsets, position_);
    std::string index;
    append_bytes(index, channel);
    append_bytes(index, static_cast<std::uint32_t>(entries.size() * (8 + 8)));
    for (const IndexEntry& e : entries) {
      append_bytes(index, e.time_ns);
      append_bytes(index, e.offset);
    }
    put(record(Opcode::message_index, index));
  }

  std::string summary;
  append_bytes(summary, chunk_begin_ns_);
  append_bytes(summary, chunk_end_ns_);
  append_bytes(summary, chunk_start);
  append_bytes(summary, index_start - chunk_start);
  append_text(summary, offsets);
  append_bytes(summary, position_ - index_start);
  append_text(summary, "zstd");
  append_bytes(summary, std::uint64_t{records.size()});
  append_bytes(summary, std::uint64_t{chunk_.size()});
  append_record(chunk_indexes_, Opcode::chunk_index, summary);
  ++chunks_;
  chunk_.clear();
  chunk_index_.clear();
}

void McapWriter::metadata(const std::string& name, const std::map<std::string, std::string>& entries) {
  end_chunk();
  std::string content;
  append_text(content, name);
  append_map(content, entries);
  const std::uint64_t start = position_;
  put(record(Opcode::metadata, content));
  std::string index;
  append_bytes(index, start);
  append_bytes(index, position_ - start);
  append_text(index, name);
  append_record(metadata_indexes_, Opcode::metadata_index, index);
  ++metadata_;
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    append_bytes(counts, static_cast<ChannelId>(i));
    append_bytes(counts, channels_[i].messages);
  }
  std::string content;
  append_bytes(content, messages_);
  append_bytes(content, static_cast<std::uint16_t>(schemas_.size()));
  append_bytes(content, static_cast<std::uint32_t>(channels_.size()));
  append_bytes(content, std::uint32_t{0});  // attachments
  append_bytes(content, metadata_);
  append_bytes(content, chunks_);
  append_bytes(content, begin_ns_);
  append_bytes(content, end_ns_);
  append_text(content, counts);
  return record(Opcode::statistics, content);
}

void McapWriter::finish() {
  end_chunk();
  std::string data_end;
  append_bytes(data_end, static_cast<std::uint32_t>(crc_));  // of all bytes before this record
  put(record(Opcode::data_end, data_end));

  std::string schemas, channels, summary, offsets;
  for (const Schema& s : schemas_) schemas += s.record;
  for (const Channel& c : channels_) channels += c.record;
  const std::uint64_t summary_start = position_;
  const auto group = [&](Opcode opcode, std::string_view records) {
    if (records.empty()) return;
    std::string offset;
    append_bytes(offset, static_cast<std::uint8_t>(opcode));
    append_bytes(offset, summary_start + summary.size());
    append_bytes(offset, std::uint64_t{records.size()});
    append_record(offsets, Opcode::summary_offset, offset);
    summary += records;
  };
  group(Opcode::schema, schemas);
  group(Opcode::channel, channels);
  group(Opcode::statistics, statistics());
  group(Opcode::chunk_index, chunk_indexes_);
  group(Opcode::metadata_index, metadata_indexes_);

  std::string tail = summary + offsets;
  append_bytes(tail, static_cast<std::uint8_t>(Opcode::footer));
  append_bytes(tail, std::uint64_t{8 + 8 + 4});
  append_bytes(tail, summary_start);
  append_bytes(tail, summary_start + summary.size());
  append_bytes(tail, crc_of(tail));  // from the summary's begin up to here
  put(tail);
  put(kMagic);
  out_.flush();
}

}  // namespace karst::mcap
