// SPDX-License-Identifier: GPL-3.0-or-later
// Writes MCAP files, the container of robotics recordings, by the specification at mcap.dev. Times
// are nanoseconds. Each file is one thread's; bytes go to a sink, so files may be pipes.
//
//     McapWriter file(write, "ros2", "cdr", rosSchemas(), {{0, "/tf"}});
//     std::string message;
//     appendMcapMessage(message, 0, 1, 2'000'000'000, bytes);  // channel 0, after two seconds
//     file.add(message);
//     file.finish();
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"

namespace ispace {

/// Schema and encoding of a channel's messages.
struct McapSchema {
    std::string name, encoding, text;
};

struct McapChannel {
    std::uint16_t schema = 0;  ///< index in the schemas
    std::string topic;
    std::map<std::string, std::string> metadata = {};
};

/// Number of a channel's messages in a file.
struct McapCount {
    McapChannel channel;
    std::string type;  ///< name of its schema
    std::uint64_t messages = 0;
};

/// The content of a file so far.
struct McapContent {
    std::vector<McapCount> channels;
    std::uint64_t messages = 0;
    std::uint64_t first = 0, last = 0;  ///< nanoseconds, of messages
};

/// Appends a message record of the channel with this index; add() takes such records.
void appendMcapMessage(std::string& out, std::uint16_t channel, std::uint32_t sequence,
                       std::uint64_t nanoseconds, std::string_view message);

/// Compression of a file's chunks.
enum class McapCompression { None, Zstd };

/// Writes an MCAP file (mcap.dev, version 0) incrementally: chunks, each with an index of its
/// messages, then a summary with statistics; CRCs everywhere. Equal messages give equal bytes,
/// independent of their grouping in calls. Memory: one chunk, and about 100 bytes for each written
/// chunk.
///
/// Written here, since Debian has no library for it.
class McapWriter {
  public:
    static constexpr std::size_t kMaxChannels = 65535;
    static constexpr auto kAllSchemas = static_cast<std::size_t>(-1);

    /// Starts a file. \param encoding of the messages, "cdr" \param always the number of schemas
    /// that the file has in any case, the first ones; others are written before their first channel
    McapWriter(ByteSink write, std::string_view profile, std::string_view encoding,
               std::vector<McapSchema> schemas, const std::vector<McapChannel>& channels,
               McapCompression compression = McapCompression::None,
               std::size_t always = kAllSchemas);

    /// Adds a channel and returns its index. \pre fewer than kMaxChannels
    std::uint16_t addChannel(McapChannel channel);
    /// Adds whole records of appendMcapMessage(), concatenated.
    void add(std::string_view messages);
    /// Writes the rest of the file.
    void finish();
    [[nodiscard]] McapContent content() const;

  private:
    using IndexEntry = std::pair<std::uint64_t, std::uint64_t>;
    struct ChunkIndex {
        std::uint64_t first = 0, last = 0, at = 0, length = 0, index_length = 0, size = 0,
                      packed_size = 0;
        std::vector<std::pair<std::uint16_t, std::uint64_t>> indices;
    };

    void put(std::string_view bytes);
    void addOne(std::string_view record);
    void finishChunk();
    [[nodiscard]] std::string_view compressionName() const;
    [[nodiscard]] std::string schemaRecord(std::size_t index) const;
    [[nodiscard]] std::string schemaRecords() const;
    [[nodiscard]] std::string channelRecord(std::size_t index) const;
    [[nodiscard]] std::string channelRecords() const;
    [[nodiscard]] std::string statisticsRecord() const;
    [[nodiscard]] std::string chunkIndexRecords() const;

    ByteSink write_;
    std::string encoding_;
    std::vector<McapSchema> schemas_;
    std::set<std::size_t> written_;  // indices of schemas
    std::vector<McapChannel> channels_;
    McapCompression compression_;
    std::uint64_t at_ = 0;
    std::uint32_t crc_ = 0;

    std::string chunk_;
    std::uint64_t chunk_first_ = 0, chunk_last_ = 0;
    std::map<std::uint16_t, std::vector<IndexEntry>> chunk_index_;

    std::vector<ChunkIndex> chunks_;
    std::map<std::uint16_t, std::uint64_t> counts_;
    std::uint64_t messages_ = 0, first_ = 0, last_ = 0;
};

}  // namespace ispace
