// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/picture.h"

#include "base/error.h"
#include "raster/pgm.h"
#include "raster/picture_module.h"
#include "raster/png_picture.h"

namespace ispace {

bool isPicture(std::string_view bytes) {
    const bool is_pgm = (bytes.starts_with("P2") || bytes.starts_with("P5")) && bytes.size() > 2 &&
                        std::string_view(" \t\r\n#").find(bytes[2]) != std::string_view::npos;
    return is_pgm || isPng(bytes) || !foreignPicture(bytes).empty();
}

Picture parsePicture(std::string_view bytes, const std::string& name) {
    if (isPng(bytes)) return parsePng(bytes, name);
    if (!foreignPicture(bytes).empty()) return decodePicture(bytes, name);
    if (bytes.starts_with("GIF8"))
        throw FormatError(
            Diagnostic{displayName(name), 0, 0,
                       "a GIF picture: convert it, for example with `convert FILE map.png`"});
    return parsePgm(bytes, name);
}

}  // namespace ispace
