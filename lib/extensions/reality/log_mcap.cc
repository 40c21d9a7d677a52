// SPDX-License-Identifier: GPL-3.0-or-later
// Reads MCAP (mcap.dev, specification; lz4 and zstd chunks). Chunks are bounded by their ratio, so
// that few bytes cannot become many.
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>

#include "base/number.h"
#include "extensions/reality/log_parts.h"
#include "extensions/reality/mcap_messages.h"

namespace ispace::reality {

namespace {

constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// \throws FormatError without a place
[[noreturn]] void refuseBytes(const std::string& message) {
    throw FormatError({"", 0, 0, message});
}

/// Reads little-endian values of a record.
class McapBytes {
  public:
    explicit McapBytes(std::string_view bytes) : bytes_(bytes) {}

    template <typename Number>
    Number number() {
        Number value{};
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string_view text() { return take(number<std::uint32_t>()); }
    std::string_view take(std::uint64_t size) {
        if (size > bytes_.size()) refuseBytes("the record ends before its last field");
        const std::string_view taken = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return taken;
    }
    [[nodiscard]] std::string_view rest() const { return bytes_; }
    [[nodiscard]] bool empty() const { return bytes_.empty(); }

  private:
    std::string_view bytes_;
};

enum McapOpcode : std::uint8_t {
    kMcapFooter = 2,
    kMcapSchema = 3,
    kMcapChannel = 4,
    kMcapMessage = 5,
    kMcapChunk = 6,
    kMcapDataEnd = 15
};

class McapRecords {
  public:
    McapRecords(const std::string& name, const McapUse& use) : name_(name), use_(use) {}

    void read(std::string_view bytes) {
        if (!bytes.starts_with(kMcapMagic))
            throw FormatError({displayName(name_), 0, 0, "no MCAP file of version 0"});
        readRecords(bytes.substr(kMcapMagic.size()), kMcapMagic.size(), false);
        if (!has_end_)
            throw FormatError({displayName(name_), 0, 0,
                               "the file ends before its data do; `mcap recover` mends it"});
    }

  private:
    struct Channel {
        std::string topic, type;
    };

    /// \param offset of the bytes in the file, or in their chunk
    void readRecords(std::string_view bytes, std::uint64_t offset, bool in_chunk) {
        McapBytes in(bytes);
        while (!in.empty() && !has_end_) {
            const std::uint64_t at = offset + (bytes.size() - in.rest().size());
            const std::string place =
                in_chunk ? chunk_place_ + ", byte " + std::to_string(at) + " of its chunk"
                         : "byte " + std::to_string(at);
            try {
                const auto opcode = in.number<std::uint8_t>();
                const auto size = in.number<std::uint64_t>();
                if (size > in.rest().size())
                    refuseBytes("a record of " + std::to_string(size) + " bytes, and " +
                                std::to_string(in.rest().size()) +
                                " follow; `mcap recover` mends a file that was cut");
                if (!in_chunk) chunk_place_ = place;
                readRecord(opcode, in.take(size), place, in_chunk);
            } catch (const FormatError& error) {
                const Diagnostic& first = error.diagnostics().front();
                if (!first.file.empty()) throw;
                throw FormatError({displayName(name_), 0, 0, place + ": " + first.message});
            }
        }
    }

    void readRecord(std::uint8_t opcode, std::string_view record, const std::string& place,
                    bool in_chunk) {
        McapBytes in(record);
        switch (opcode) {
            case kMcapSchema: {
                const auto id = in.number<std::uint16_t>();
                schemas_[id] = in.text();
                return;
            }
            case kMcapChannel:
                return readChannel(in);
            case kMcapMessage:
                return readMessage(in, place);
            case kMcapChunk:
                if (in_chunk) refuseBytes("a chunk within a chunk");
                return readChunk(in);
            case kMcapDataEnd:
            case kMcapFooter:
                if (in_chunk) refuseBytes("the data end within a chunk");
                has_end_ = true;
                return;
            default:
                return;
        }
    }

    void readChannel(McapBytes in) {
        const auto id = in.number<std::uint16_t>();
        const auto schema = in.number<std::uint16_t>();
        Channel channel{std::string(in.text()), ""};
        const std::string_view encoding = in.text();
        const auto type = schemas_.find(schema);
        if (type != schemas_.end()) channel.type = type->second;
        if (encoding == "ros1")
            refuseBytes(
                "messages of ROS 1, which are not read; rosbags-convert makes a bag of "
                "ROS 2");
        if (encoding != "cdr") channel.type.clear();
        channels_[id] = std::move(channel);
    }

    void readMessage(McapBytes in, const std::string& place) {
        const auto id = in.number<std::uint16_t>();
        static_cast<void>(in.number<std::uint32_t>());
        const auto time = in.number<std::uint64_t>();
        static_cast<void>(in.number<std::uint64_t>());
        const auto channel = channels_.find(id);
        if (channel == channels_.end())
            refuseBytes("a message of channel " + std::to_string(id) + ", which the file lacks");
        use_({channel->second.topic, channel->second.type, time, in.rest(), place});
    }

    void readChunk(McapBytes in) {
        static_cast<void>(in.number<std::uint64_t>());
        static_cast<void>(in.number<std::uint64_t>());
        const auto size = in.number<std::uint64_t>();
        const auto crc = in.number<std::uint32_t>();
        const std::string_view compression = in.text();
        const std::string_view packed = in.take(in.number<std::uint64_t>());
        std::string unpacked;
        std::string_view records = packed;
        if (!compression.empty()) {
            unpacked = unpackedChunk(compression, packed, size);
            records = unpacked;
        }
        if (records.size() != size) refuseBytes("the chunk has another size than it says");
        if (crc != 0 &&
            crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size()) != crc)
            refuseBytes("the chunk's checksum differs: the file is damaged");
        readRecords(records, 0, true);
    }

    const std::string& name_;
    const McapUse& use_;
    std::map<std::uint16_t, std::string> schemas_;
    std::map<std::uint16_t, Channel> channels_;
    std::string chunk_place_;
    bool has_end_ = false;
};

std::string unpackedLz4(std::string_view packed, std::size_t size) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0)
        throw std::bad_alloc();
    const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
        context, &LZ4F_freeDecompressionContext);
    std::string out(size, '\0');
    std::size_t written = 0, used = 0;
    while (used < packed.size()) {
        std::size_t room = size - written, rest = packed.size() - used;
        const std::size_t result = LZ4F_decompress(context, out.data() + written, &room,
                                                   packed.data() + used, &rest, nullptr);
        if (LZ4F_isError(result) != 0)
            refuseBytes(std::string("lz4: ") + LZ4F_getErrorName(result));
        written += room;
        used += rest;
        if (result == 0) break;
        if (room == 0 && rest == 0) refuseBytes("lz4: the chunk is larger than it says");
    }
    out.resize(written);
    return out;
}

}  // namespace

std::string unpackedChunk(std::string_view compression, std::string_view packed,
                          std::uint64_t size) {
    constexpr std::uint64_t kMostChunk = std::uint64_t{1} << 30U, kFree = 64'000'000, kRatio = 1000;
    if (size > kMostChunk || size > kFree + kRatio * packed.size())
        refuseBytes("a chunk of " + std::to_string(size) + " bytes when unpacked, of " +
                    std::to_string(packed.size()));
    if (compression == "lz4") return unpackedLz4(packed, size);
    if (compression != "zstd")
        refuseBytes("chunks packed by `" + std::string(compression) +
                    "`; zstd, lz4 and none are read");
    std::string out(size, '\0');
    const std::size_t result =
        ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
    if (ZSTD_isError(result) != 0) refuseBytes(std::string("zstd: ") + ZSTD_getErrorName(result));
    out.resize(result);
    return out;
}

bool isMcap(std::string_view bytes) { return bytes.starts_with(kMcapMagic); }

void readMcap(std::string_view bytes, const std::string& name, const McapUse& use) {
    McapRecords(name, use).read(bytes);
}

void addMcap(std::string_view bytes, const std::string& name, RosLogBuilder& builder) {
    readMcap(bytes, name, [&](const McapMessage& message) {
        if (builder.reads(message.type))
            builder.add(message.topic, message.type, message.bytes, name, message.place);
    });
}

}  // namespace ispace::reality
