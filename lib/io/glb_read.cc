// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/glb.h"
#include "record/text.h"

namespace ispace {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN" and a zero
constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;

[[noreturn]] void fail(const std::string& name, const std::string& message) {
    throw FormatError(Diagnostic{displayName(name), 0, 0, message});
}

/// Little-endian. \pre four bytes from `at` on
std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

struct Chunks {
    std::string_view json, binary;
};

/// Takes the container apart; every length is checked against what is there.
Chunks chunksOf(std::string_view bytes, const std::string& name) {
    if (bytes.size() < kHeaderSize)
        fail(name, "truncated: " + std::to_string(bytes.size()) + " of at least " +
                       std::to_string(kHeaderSize) + " bytes");
    if (const std::uint32_t version = word(bytes, 4); version != 2)
        fail(name, "binary glTF version " + std::to_string(version) + ", wanted 2");
    const std::size_t length = word(bytes, 8);
    if (bytes.size() != length)
        fail(name, (bytes.size() < length ? "truncated: " : "damaged: ") +
                       std::to_string(bytes.size()) + " of " + std::to_string(length) + " bytes");
    Chunks chunks;
    for (std::size_t at = kHeaderSize, index = 0; at < length; ++index) {
        if (length - at < kChunkHeaderSize) fail(name, "damaged: a chunk header is cut off");
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += kChunkHeaderSize;
        if (size > length - at)
            fail(name, "damaged: a chunk of " + std::to_string(size) + " bytes where " +
                           std::to_string(length - at) + " are left");
        // Chunks of other kinds are extensions, to be passed over.
        if (index == 0 && type == kJsonChunk) chunks.json = bytes.substr(at, size);
        if (index == 1 && type == kBinaryChunk) chunks.binary = bytes.substr(at, size);
        at += size;
    }
    if (chunks.json.empty()) fail(name, "damaged: wanted JSON as the first chunk");
    return chunks;
}

/// Takes the few numbers we need out of glTF's JSON as it streams by: the top level's
/// extras.ispace and bufferViews. The parser keeps no tree and its depth costs no stack, so that
/// neither size nor nesting of a hostile file matters.
class Finder : public nlohmann::json_sax<nlohmann::json> {
  public:
    struct View {
        std::uint64_t buffer = 0, offset = 0, length = 0;
    };
    std::optional<std::uint64_t> records;  ///< extras.ispace
    std::vector<View> views;

    /// Stands for a value that is no whole number from 0 on: beyond any file.
    static constexpr std::uint64_t kWrong = std::numeric_limits<std::uint64_t>::max();

    bool null() override { return take(kWrong); }
    bool boolean(bool /*value*/) override { return take(kWrong); }
    bool number_integer(number_integer_t /*value*/) override { return take(kWrong); }
    bool number_unsigned(number_unsigned_t value) override { return take(value); }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
        return take(kWrong);
    }
    bool string(string_t& /*value*/) override { return take(kWrong); }
    bool binary(binary_t& /*value*/) override { return take(kWrong); }

    bool key(string_t& name) override {
        (depth_ == 1 ? section_ : key_) = name;
        return true;
    }
    bool start_object(std::size_t /*size*/) override {
        if (depth_ == 2 && section_ == "bufferViews") views.emplace_back();
        return open();
    }
    bool start_array(std::size_t /*size*/) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        error_position = position;
        return false;
    }
    std::size_t error_position = 0;

  private:
    bool take(std::uint64_t value) {
        if (depth_ == 2 && section_ == "extras" && key_ == "ispace") records = value;
        if (depth_ == 3 && section_ == "bufferViews" && !views.empty()) {
            if (key_ == "buffer") views.back().buffer = value;
            if (key_ == "byteOffset") views.back().offset = value;
            if (key_ == "byteLength") views.back().length = value;
        }
        return true;
    }
    bool open() {
        ++depth_;
        return true;
    }
    bool close() {
        --depth_;
        return true;
    }

    std::size_t depth_ = 0;
    std::string section_, key_;
};

}  // namespace

bool isGlb(std::string_view bytes) { return bytes.starts_with(kMagic); }

Document readGlb(std::string_view bytes, const std::string& name, const Schemas& schemas) {
    if (!isGlb(bytes)) fail(name, "not a binary glTF file: wanted `glTF` at its beginning");
    const Chunks chunks = chunksOf(bytes, name);
    Finder finder;
    if (!nlohmann::json::sax_parse(chunks.json.begin(), chunks.json.end(), &finder))
        fail(name, "damaged: bad JSON at byte " + std::to_string(finder.error_position) +
                       " of its chunk");
    if (!finder.records)
        fail(name,
             "no ispace records in this glTF file: compile the environment with `envc … -o "
             "room.glb`");
    if (*finder.records >= finder.views.size())
        fail(name, "damaged: extras.ispace names none of the " +
                       std::to_string(finder.views.size()) + " buffer views");
    const Finder::View view = finder.views[*finder.records];
    if (view.buffer != 0 || view.offset > chunks.binary.size() ||
        view.length > chunks.binary.size() - view.offset)
        fail(name, "damaged: the records lie outside of its " +
                       std::to_string(chunks.binary.size()) + " bytes of data");
    return readRecordText(chunks.binary.substr(view.offset, view.length), name, schemas);
}

}  // namespace ispace
