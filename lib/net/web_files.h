// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace ispace {

/// A file of the page that --web serves; it is part of the program.
struct WebFile {
    std::string_view path;  ///< in a request, e.g. "/map.js"
    std::string_view type;  ///< MIME type
    std::string_view bytes;
};

/// Null if there is none of that path.
const WebFile* webFile(std::string_view path);

}  // namespace ispace
