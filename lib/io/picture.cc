// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/picture.h"

#include "base/error.h"
#include "io/pgm.h"
#include "io/png_picture.h"

namespace ispace {

namespace {

/// What a picture is that neither reader knows; "" for others.
std::string otherFormat(std::string_view bytes) {
    const auto begins = [bytes](std::string_view magic) { return bytes.starts_with(magic); };
    if (begins("\xff\xd8\xff")) return "JPEG";
    if (begins("GIF8")) return "GIF";
    if (begins("II*") || begins("MM")) return "TIFF";
    if (begins("BM")) return "BMP";
    if (begins("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "WebP";
    for (const char* magic : {"P1", "P3", "P4", "P6", "P7"})
        if (begins(magic)) return std::string("PNM (") + magic + ')';
    return "";
}

}  // namespace

Picture parsePicture(std::string_view bytes, const std::string& name) {
    if (isPng(bytes)) return parsePng(bytes, name);
    if (const std::string format = otherFormat(bytes); !format.empty())
        throw FormatError(Diagnostic{displayName(name), 0, 0,
                                     "a " + format +
                                         " picture, wanted PNG or PGM: convert it, for example "
                                         "with `convert FILE map.png`"});
    return parsePgm(bytes, name);
}

}  // namespace ispace
