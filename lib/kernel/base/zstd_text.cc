// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/zstd_text.h"

#include <zstd.h>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "base/message.h"

namespace ispace {

namespace {

std::size_t checked(std::size_t result) {
    if (ZSTD_isError(result) != 0)
        throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(result));
    return result;
}

}  // namespace

struct ZstdPacker::State {
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context{ZSTD_createCCtx(), &ZSTD_freeCCtx};
};

ZstdPacker::ZstdPacker() : state_(std::make_unique<State>()) {
    ZSTD_CCtx* const context = state_->context.get();
    if (context == nullptr) throw std::bad_alloc();
    checked(ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, ZSTD_CLEVEL_DEFAULT));
    checked(ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1));
}

ZstdPacker::~ZstdPacker() = default;

std::string ZstdPacker::run(std::string_view text, bool is_last) {
    std::string bytes;
    ZSTD_inBuffer from{text.data(), text.size(), 0};
    const ZSTD_EndDirective how = is_last ? ZSTD_e_end : ZSTD_e_flush;
    for (std::size_t left = 1; left != 0 || from.pos < from.size;) {
        const std::size_t size = bytes.size();
        bytes.resize(size + ZSTD_CStreamOutSize());
        ZSTD_outBuffer to{bytes.data() + size, bytes.size() - size, 0};
        left = checked(ZSTD_compressStream2(state_->context.get(), &to, &from, how));
        bytes.resize(size + to.pos);
    }
    return bytes;
}

std::string ZstdPacker::pack(std::string_view text) {
    return text.empty() ? std::string() : run(text, false);
}

std::string ZstdPacker::end() { return run({}, true); }

struct TextFile::Unpacker {
    std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context{ZSTD_createDCtx(), &ZSTD_freeDCtx};
    std::string bytes = {};                  // read
    std::size_t used = 0;                    // of them
    bool is_full = false;                    // more text may wait in the context
    std::uint64_t packed = 0, unpacked = 0;  // bytes so far
};

/// A table of numbers, of which each line differs, takes at least a thousandth of its bytes; what
/// is packed tighter, as blank lines are, keeps a reader busy for hours.
constexpr std::uint64_t kMaxRatio = 1000, kFreeBytes = 64'000'000;

TextFile::TextFile(const std::string& name, InputKind kind) : name_(name), file_(name, kind) {
    if (!name.ends_with(kZstdSuffix)) return;
    unpacker_ = std::make_unique<Unpacker>();
    if (unpacker_->context == nullptr) throw std::bad_alloc();
}

TextFile::~TextFile() = default;
TextFile::TextFile(TextFile&&) noexcept = default;
TextFile& TextFile::operator=(TextFile&&) noexcept = default;

bool TextFile::read(std::string& text) {
    if (!unpacker_) return file_.read(text);
    Unpacker& own = *unpacker_;
    for (;;) {
        if (own.used == own.bytes.size() && !own.is_full) {
            own.bytes.clear();
            own.used = 0;
            if (!file_.read(own.bytes)) return false;
        }
        const std::size_t size = text.size();
        text.resize(size + ZSTD_DStreamOutSize());
        ZSTD_outBuffer to{text.data() + size, text.size() - size, 0};
        ZSTD_inBuffer from{own.bytes.data(), own.bytes.size(), own.used};
        const std::size_t result = ZSTD_decompressStream(own.context.get(), &to, &from);
        text.resize(size + to.pos);
        if (ZSTD_isError(result) != 0)
            throw FormatError({displayName(name_), 0, 0,
                               std::string("cannot be unpacked: ") + ZSTD_getErrorName(result)});
        own.packed += from.pos - own.used;
        own.unpacked += to.pos;
        if (own.unpacked > kFreeBytes + kMaxRatio * own.packed)
            throw FormatError({displayName(name_), 0, 0,
                               "a byte is unpacked to more than 1000 bytes of text: unpack it with "
                               "`zstd -d` if that is right"});
        own.used = from.pos;
        own.is_full = to.pos == to.size;
        if (to.pos > 0) return true;
    }
}

}  // namespace ispace
