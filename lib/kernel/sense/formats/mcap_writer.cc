// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace ispace {

namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = 1U << 20U;

enum Opcode : std::uint8_t {
    kHeader = 0x01,
    kFooter = 0x02,
    kSchema = 0x03,
    kChannel = 0x04,
    kMessage = 0x05,
    kChunk = 0x06,
    kMessageIndex = 0x07,
    kChunkIndex = 0x08,
    kStatistics = 0x0b,
    kSummaryOffset = 0x0e,
    kDataEnd = 0x0f,
};

/// Size of a message record's header, and offsets of its fields.
constexpr std::size_t kRecordHead = 9, kChannelAt = kRecordHead, kTimeAt = kRecordHead + 6;

template <typename Number>
Number numberAt(std::string_view bytes, std::size_t at) {
    Number value;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

std::uint32_t crcOn(std::uint32_t crc, std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void appendHead(std::string& out, Opcode opcode, std::uint64_t length) {
    appendLittle(out, static_cast<std::uint8_t>(opcode));
    appendLittle(out, length);
}

void appendRecord(std::string& out, Opcode opcode, std::string_view content) {
    appendHead(out, opcode, content.size());
    out += content;
}

void appendText(std::string& out, std::string_view text) {
    appendLittle(out, static_cast<std::uint32_t>(text.size()));
    out += text;
}

/// Appends a map or an array of pairs: its size in bytes, then the pairs.
template <typename Pairs>
void appendPairs(std::string& out, const Pairs& pairs) {
    using Pair = typename Pairs::value_type;
    constexpr std::size_t kBytes =
        sizeof(typename Pair::first_type) + sizeof(typename Pair::second_type);
    appendLittle(out, static_cast<std::uint32_t>(kBytes * pairs.size()));
    for (const auto& [key, value] : pairs) {
        appendLittle(out, key);
        appendLittle(out, value);
    }
}

/// Compresses at zstd's default level, as one frame in one thread, which gives equal bytes each
/// time.
std::string packedByZstd(const std::string& bytes) {
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(),
                                           ZSTD_CLEVEL_DEFAULT);
    if (ZSTD_isError(size) != 0)
        throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
    packed.resize(size);
    return packed;
}

}  // namespace

void appendMcapMessage(std::string& out, std::uint16_t channel, std::uint32_t sequence,
                       std::uint64_t nanoseconds, std::string_view message) {
    constexpr std::size_t kFields = 22;
    appendHead(out, kMessage, kFields + message.size());
    appendLittle(out, channel);
    appendLittle(out, sequence);
    appendLittle(out, nanoseconds);  // log time
    appendLittle(out, nanoseconds);  // publish time
    out += message;
}

McapWriter::McapWriter(ByteSink write, std::string_view profile, std::string_view encoding,
                       std::vector<McapSchema> schemas, const std::vector<McapChannel>& channels,
                       McapCompression compression, std::size_t always)
    : write_(std::move(write)),
      encoding_(encoding),
      schemas_(std::move(schemas)),
      compression_(compression) {
    std::string header, begin(kMagic);
    appendText(header, profile);
    appendText(header, "ispace");
    appendRecord(begin, kHeader, header);
    for (std::size_t i = 0; i < std::min(always, schemas_.size()); ++i) written_.insert(i);
    put(begin + schemaRecords());
    for (const McapChannel& channel : channels) addChannel(channel);
}

void McapWriter::put(std::string_view bytes) {
    crc_ = crcOn(crc_, bytes);
    at_ += bytes.size();
    write_(bytes);
}

std::uint16_t McapWriter::addChannel(McapChannel channel) {
    const std::size_t index = channels_.size();
    channels_.push_back(std::move(channel));
    // Its messages follow in later chunks.
    const std::size_t schema = channels_[index].schema;
    put((written_.insert(schema).second ? schemaRecord(schema) : "") + channelRecord(index));
    return static_cast<std::uint16_t>(index);
}

void McapWriter::add(std::string_view messages) {
    while (!messages.empty()) {
        const std::size_t size = kRecordHead + numberAt<std::uint64_t>(messages, 1);
        addOne(messages.substr(0, size));
        messages.remove_prefix(size);
    }
}

void McapWriter::addOne(std::string_view record) {
    const auto channel = numberAt<std::uint16_t>(record, kChannelAt);
    const auto time = numberAt<std::uint64_t>(record, kTimeAt);
    const bool opens = chunk_.empty();
    chunk_first_ = opens ? time : std::min(chunk_first_, time);
    chunk_last_ = opens ? time : std::max(chunk_last_, time);
    chunk_index_[channel].emplace_back(time, chunk_.size());
    chunk_ += record;
    first_ = messages_ == 0 ? time : std::min(first_, time);
    last_ = std::max(last_, time);
    ++messages_;
    ++counts_[channel];
    if (chunk_.size() >= kChunkBytes) finishChunk();
}

std::string_view McapWriter::compressionName() const {
    return compression_ == McapCompression::Zstd ? "zstd" : "";
}

void McapWriter::finishChunk() {
    if (chunk_.empty()) return;
    ChunkIndex index;
    index.first = chunk_first_;
    index.last = chunk_last_;
    index.at = at_;
    index.size = chunk_.size();
    const bool is_packed = compression_ == McapCompression::Zstd;
    const std::string packed = is_packed ? packedByZstd(chunk_) : "";
    const std::string& stored = is_packed ? packed : chunk_;
    index.packed_size = stored.size();
    std::string head, fields;
    appendLittle(fields, chunk_first_);
    appendLittle(fields, chunk_last_);
    appendLittle(fields, index.size);
    appendLittle(fields, crcOn(0, chunk_));
    appendText(fields, compressionName());
    appendLittle(fields, index.packed_size);
    appendHead(head, kChunk, fields.size() + stored.size());
    put(head + fields);
    put(stored);
    index.length = at_ - index.at;

    std::string records;
    for (const auto& [channel, entries] : chunk_index_) {
        index.indices.emplace_back(channel, at_ + records.size());
        std::string content;
        appendLittle(content, channel);
        appendPairs(content, entries);
        appendRecord(records, kMessageIndex, content);
    }
    index.index_length = records.size();
    put(records);
    chunks_.push_back(std::move(index));
    chunk_.clear();
    chunk_index_.clear();
}

std::string McapWriter::schemaRecord(std::size_t index) const {
    std::string content, out;
    appendLittle(content, static_cast<std::uint16_t>(index + 1));  // schema 0 is reserved
    appendText(content, schemas_[index].name);
    appendText(content, schemas_[index].encoding);
    appendText(content, schemas_[index].text);
    appendRecord(out, kSchema, content);
    return out;
}

std::string McapWriter::schemaRecords() const {
    std::string out;
    for (const std::size_t index : written_) out += schemaRecord(index);
    return out;
}

std::string McapWriter::channelRecord(std::size_t index) const {
    std::string content, out;
    appendLittle(content, static_cast<std::uint16_t>(index));
    appendLittle(content, static_cast<std::uint16_t>(channels_[index].schema + 1));
    appendText(content, channels_[index].topic);
    appendText(content, encoding_);
    std::string metadata;
    for (const auto& [key, value] : channels_[index].metadata) {
        appendText(metadata, key);
        appendText(metadata, value);
    }
    appendText(content, metadata);  // a map has its bytes before it, as a text has
    appendRecord(out, kChannel, content);
    return out;
}

McapContent McapWriter::content() const {
    McapContent content{{}, messages_, first_, last_};
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        const auto count = counts_.find(static_cast<std::uint16_t>(i));
        content.channels.push_back({channels_[i], schemas_[channels_[i].schema].name,
                                    count == counts_.end() ? 0 : count->second});
    }
    return content;
}

std::string McapWriter::channelRecords() const {
    std::string out;
    for (std::size_t i = 0; i < channels_.size(); ++i) out += channelRecord(i);
    return out;
}

std::string McapWriter::statisticsRecord() const {
    std::string content, out;
    appendLittle(content, messages_);
    appendLittle(content, static_cast<std::uint16_t>(written_.size()));
    appendLittle(content, static_cast<std::uint32_t>(channels_.size()));
    appendLittle(content, std::uint32_t{0});  // attachments
    appendLittle(content, std::uint32_t{0});  // metadata
    appendLittle(content, static_cast<std::uint32_t>(chunks_.size()));
    appendLittle(content, first_);
    appendLittle(content, last_);
    appendPairs(content, counts_);
    appendRecord(out, kStatistics, content);
    return out;
}

std::string McapWriter::chunkIndexRecords() const {
    std::string out;
    for (const ChunkIndex& chunk : chunks_) {
        std::string content;
        for (const std::uint64_t value : {chunk.first, chunk.last, chunk.at, chunk.length})
            appendLittle(content, value);
        appendPairs(content, chunk.indices);
        appendLittle(content, chunk.index_length);
        appendText(content, compressionName());
        appendLittle(content, chunk.packed_size);
        appendLittle(content, chunk.size);
        appendRecord(out, kChunkIndex, content);
    }
    return out;
}

void McapWriter::finish() {
    finishChunk();
    std::string content, end;
    appendLittle(content, crc_);
    appendRecord(end, kDataEnd, content);
    put(end);

    const std::uint64_t summary_at = at_;
    std::string summary, offsets;
    const auto add_group = [&](Opcode opcode, const std::string& records) {
        if (records.empty()) return;
        std::string group;
        appendLittle(group, static_cast<std::uint8_t>(opcode));
        appendLittle(group, summary_at + summary.size());
        appendLittle(group, static_cast<std::uint64_t>(records.size()));
        appendRecord(offsets, kSummaryOffset, group);
        summary += records;
    };
    add_group(kSchema, schemaRecords());
    add_group(kChannel, channelRecords());
    add_group(kStatistics, statisticsRecord());
    add_group(kChunkIndex, chunkIndexRecords());
    const std::uint64_t offsets_at = summary_at + summary.size();
    summary += offsets;

    constexpr std::uint64_t kFooterLength = 20;
    appendHead(summary, kFooter, kFooterLength);
    appendLittle(summary, summary_at);
    appendLittle(summary, offsets_at);
    appendLittle(summary, crcOn(0, summary));
    summary += kMagic;
    put(summary);
}

}  // namespace ispace
