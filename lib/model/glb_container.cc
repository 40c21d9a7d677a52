// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/error.h"
#include "model/glb_file.h"

namespace ispace {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN" and a zero
constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;
constexpr std::size_t kMaxBytes = 0x7fff0000;

/// Little-endian. \pre four bytes from `at` on
std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

void appendWord(std::string& out, std::size_t value) {
    for (int i = 0; i < 4; ++i) {
        out += static_cast<char>(value & 255U);
        value >>= 8U;
    }
}

[[noreturn]] void failFile(const std::string& name, const std::string& message) {
    throw FormatError(Diagnostic{displayName(name), 0, 0, message});
}

std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

}  // namespace

GlbChunks glbChunks(std::string_view bytes, const std::string& name) {
    if (bytes.size() < kHeaderSize)
        failFile(name, "truncated: " + std::to_string(bytes.size()) + " of at least " +
                           std::to_string(kHeaderSize) + " bytes");
    if (const std::uint32_t version = word(bytes, 4); version != kVersion)
        failFile(name, "binary glTF version " + std::to_string(version) + ", wanted 2");
    const std::size_t length = word(bytes, 8);
    if (bytes.size() != length)
        failFile(name, (bytes.size() < length ? "truncated: " : "damaged: ") +
                           std::to_string(bytes.size()) + " of " + std::to_string(length) +
                           " bytes");
    GlbChunks chunks;
    for (std::size_t at = kHeaderSize, index = 0; at < length; ++index) {
        if (length - at < kChunkHeaderSize) failFile(name, "damaged: a chunk header is cut off");
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += kChunkHeaderSize;
        if (size > length - at)
            failFile(name, "damaged: a chunk of " + std::to_string(size) + " bytes where " +
                               std::to_string(length - at) + " are left");
        // Chunks of other kinds are extensions, to be passed over.
        if (index == 0 && type == kJsonChunk) chunks.json = bytes.substr(at, size);
        if (index == 1 && type == kBinaryChunk) chunks.binary = bytes.substr(at, size);
        at += size;
    }
    if (chunks.json.empty()) failFile(name, "damaged: wanted JSON as the first chunk");
    return chunks;
}

std::string glbContainer(std::string_view json, std::span<const std::string_view> parts) {
    std::string out;
    writeGlbContainer({std::string(json)}, parts, [&out](std::string_view bytes) { out += bytes; });
    return out;
}

void writeGlbContainer(std::vector<std::string> json, std::span<const std::string_view> parts,
                       const ByteSink& sink) {
    std::size_t size = 0, json_text = 0;
    for (const std::string_view part : parts) size += part.size();
    for (const std::string& piece : json) json_text += piece.size();
    const std::size_t json_size = padded(json_text), binary_size = padded(size);
    const std::size_t length = kHeaderSize + 2 * kChunkHeaderSize + json_size + binary_size;
    if (length > kMaxBytes) failFile("", "the model is too large for a glTF file");
    std::string head(kMagic);
    appendWord(head, kVersion);
    appendWord(head, length);
    appendWord(head, json_size);
    appendWord(head, kJsonChunk);
    sink(head);
    for (std::string& piece : json) {
        sink(piece);
        piece = std::string();
    }
    head.assign(json_size - json_text, ' ');
    appendWord(head, binary_size);
    appendWord(head, kBinaryChunk);
    sink(head);
    for (const std::string_view part : parts) sink(part);
    sink(std::string(binary_size - size, '\0'));
}

}  // namespace ispace
