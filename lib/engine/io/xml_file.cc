// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/xml_file.h"

#include <algorithm>
#include <utility>

#include "io/importers.h"

namespace ispace {

XmlFile::XmlFile(std::string_view bytes, std::string name) : name_(std::move(name)) {
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] == '\n') line_ends_.push_back(static_cast<std::ptrdiff_t>(i));
    const pugi::xml_parse_result result =
        document_.load_buffer(bytes.data(), bytes.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
        failFile(name_, std::string("bad XML: ") + result.description(), lineAt(result.offset));
}

void XmlFile::fail(pugi::xml_node node, const std::string& message) const {
    failFile(name_, message, lineOf(node));
}

int XmlFile::lineAt(std::ptrdiff_t offset) const {
    const auto behind = std::lower_bound(line_ends_.begin(), line_ends_.end(), offset);
    return 1 + static_cast<int>(behind - line_ends_.begin());
}

}  // namespace ispace
