// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: builds PNG files of any kind without libpng, which would otherwise test itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ispace {

inline std::string bigEndian32(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
}

/// Returns a chunk with its check sum (CRC-32).
inline std::string pngChunk(const std::string& type, const std::string& content) {
    std::uint32_t crc = 0xffffffff;
    for (const char c : type + content) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xedb88320U : crc >> 1U;
    }
    return bigEndian32(static_cast<std::uint32_t>(content.size())) + type + content +
           bigEndian32(~crc);
}

/// Returns the bytes as a zlib stream, not compressed.
/// \pre less than 64 KiB
inline std::string stored(const std::string& bytes) {
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    const auto size = static_cast<std::uint16_t>(bytes.size());
    std::string out("\x78\x01\x01", 3);
    for (const unsigned value : {unsigned{size}, ~unsigned{size}}) {
        out += static_cast<char>(value);
        out += static_cast<char>(value >> 8U);
    }
    return out + bytes + bigEndian32(b << 16U | a);
}

/// Builds a PNG from rows of samples in the packing of its format. `extra`: chunks before the
/// samples.
inline std::string pngFile(std::uint32_t width, char depth, char color_type,
                           const std::vector<std::string>& rows, const std::string& extra = "") {
    std::string data;
    for (const std::string& row : rows) data += '\0' + row;
    const std::string header = bigEndian32(width) +
                               bigEndian32(static_cast<std::uint32_t>(rows.size())) + depth +
                               color_type + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", header) + extra + pngChunk("IDAT", stored(data)) +
           pngChunk("IEND", "");
}

}  // namespace ispace
