// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: the objects of a PDF as text, wherever its writer has put them.
#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ispace {

/// Inflates the zlib stream at the beginning of some bytes; what follows it is ignored.
inline std::string inflated(std::string_view bytes) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::runtime_error("zlib");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::string text;
    std::array<char, 4096> part{};
    int status = Z_OK;
    while (status == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(part.data());
        stream.avail_out = static_cast<uInt>(part.size());
        status = inflate(&stream, Z_NO_FLUSH);
        text.append(part.data(), part.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("no zlib stream");
    return text;
}

/// Returns a PDF with the objects behind it that it has in compressed streams, as Cairo writes them
/// since 1.18 (ISO 32000-1, 7.5.7).
inline std::string objectsOf(const std::string& pdf) {
    constexpr std::string_view kStream = "stream\n";
    std::string all = pdf;
    for (std::size_t at = pdf.find("/ObjStm"); at != std::string::npos;
         at = pdf.find("/ObjStm", at + 1)) {
        const std::size_t begin = pdf.find(kStream, at);
        if (begin == std::string::npos) throw std::runtime_error("an object stream without stream");
        all += inflated(std::string_view(pdf).substr(begin + kStream.size()));
    }
    return all;
}

}  // namespace ispace
