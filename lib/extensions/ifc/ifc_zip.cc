// SPDX-License-Identifier: GPL-3.0-or-later
// Reads .ifczip (buildingSMART: a zip with one .ifc). The unpacked size is paid for before memory
// is allocated, and no more is unpacked, so a zip bomb ends at the budget.
#include "extensions/ifc/ifc_zip.h"

#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>

#include "base/message.h"
#include "io/importers.h"

namespace ispace::ifc {

namespace {

constexpr std::string_view kSuffix = ".ifc";

bool isLetter(char c, char wanted) {
    return c == wanted || (c >= 'A' && c <= 'Z' && c - 'A' + 'a' == wanted);
}

/// An archive in memory, as minizip reads files.
struct ZipBytes {
    std::string_view bytes;
    std::uint64_t at = 0;
};

voidpf openBytes(voidpf opaque, const void* /*name*/, int /*mode*/) { return opaque; }

uLong readBytes(voidpf opaque, voidpf /*stream*/, void* to, uLong size) {
    auto& file = *static_cast<ZipBytes*>(opaque);
    if (file.at >= file.bytes.size()) return 0;
    const auto count = std::min<std::uint64_t>(size, file.bytes.size() - file.at);
    std::memcpy(to, file.bytes.data() + file.at, count);
    file.at += count;
    return static_cast<uLong>(count);
}

uLong writeBytes(voidpf /*opaque*/, voidpf /*stream*/, const void* /*from*/, uLong /*size*/) {
    return 0;
}

ZPOS64_T tellBytes(voidpf opaque, voidpf /*stream*/) { return static_cast<ZipBytes*>(opaque)->at; }

long seekBytes(voidpf opaque, voidpf /*stream*/, ZPOS64_T offset, int origin) {
    auto& file = *static_cast<ZipBytes*>(opaque);
    const std::uint64_t base = origin == ZLIB_FILEFUNC_SEEK_CUR   ? file.at
                               : origin == ZLIB_FILEFUNC_SEEK_END ? file.bytes.size()
                                                                  : 0;
    if (offset > file.bytes.size() || base + offset > file.bytes.size()) return -1;
    file.at = base + offset;
    return 0;
}

int closeBytes(voidpf /*opaque*/, voidpf /*stream*/) { return 0; }
int errorOfBytes(voidpf /*opaque*/, voidpf /*stream*/) { return 0; }

struct CloseZip {
    void operator()(void* zip) const { unzClose(zip); }
};

bool hasSuffix(std::string_view name) {
    return name.size() >= kSuffix.size() &&
           std::equal(kSuffix.begin(), kSuffix.end(), name.end() - kSuffix.size(),
                      [](char wanted, char c) { return isLetter(c, wanted); });
}

}  // namespace

bool isIfcZip(std::string_view bytes) {
    // The directory of an archive is its end, but for a comment.
    constexpr std::size_t kDirectory = 1 << 16;
    if (!bytes.starts_with("PK\3\4")) return false;
    if (bytes.size() > kDirectory) bytes.remove_prefix(bytes.size() - kDirectory);
    return std::search(bytes.begin(), bytes.end(), kSuffix.begin(), kSuffix.end(), isLetter) !=
           bytes.end();
}

/// The first entry that ends in .ifc. Its stated size is paid from the work before memory is taken,
/// and no more than that size is unpacked: a zip bomb costs a message.
std::string unzippedIfc(std::string_view bytes, const std::string& operand, Budget& work) {
    ZipBytes file{bytes};
    zlib_filefunc64_def memory{openBytes, readBytes,  writeBytes,   tellBytes,
                               seekBytes, closeBytes, errorOfBytes, &file};
    const std::unique_ptr<void, CloseZip> zip(unzOpen2_64("", &memory));
    if (!zip) failFile(operand, "a damaged zip archive: its directory cannot be read");
    unz_file_info64 info;
    std::array<char, 512> name{};
    int status = unzGoToFirstFile(zip.get());
    for (; status == UNZ_OK; status = unzGoToNextFile(zip.get())) {
        if (unzGetCurrentFileInfo64(zip.get(), &info, name.data(), name.size() - 1, nullptr, 0,
                                    nullptr, 0) != UNZ_OK)
            failFile(operand, "a damaged zip archive: an entry that cannot be read");
        if (hasSuffix(name.data())) break;
    }
    if (status != UNZ_OK) failFile(operand, "a zip archive without a file that ends in .ifc");
    const std::string entry = excerpt(name.data());
    if ((info.flag & 1U) != 0) failFile(operand, entry + " in the archive is encrypted");
    if (!work.take(Budget::unitsOf(info.uncompressed_size)))
        failFile(operand, entry + " in the archive makes " + work.excess());
    std::string text(info.uncompressed_size, '\0');
    std::size_t read = 0;
    if (unzOpenCurrentFile(zip.get()) != UNZ_OK)
        failFile(operand,
                 info.compression_method != 0 && info.compression_method != Z_DEFLATED
                     ? entry + " in the archive is packed in an unknown way: pack it with zip"
                     : "a damaged zip archive: " + entry + " cannot be unpacked");
    constexpr std::size_t kPiece = 1 << 20;
    while (read < text.size()) {
        const int count =
            unzReadCurrentFile(zip.get(), text.data() + read,
                               static_cast<unsigned>(std::min(kPiece, text.size() - read)));
        if (count <= 0) break;
        read += static_cast<std::size_t>(count);
    }
    // Closing compares the checksum.
    if (unzCloseCurrentFile(zip.get()) != UNZ_OK || read < text.size())
        failFile(operand, "a damaged zip archive: " + entry + " cannot be unpacked");
    return text;
}

}  // namespace ispace::ifc
