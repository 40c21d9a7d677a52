// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/svg.h"

#include <utility>

#include "io/import_records.h"
#include "io/line_plan.h"
#include "io/svg_shapes.h"

namespace ispace {

bool isSvg(std::string_view bytes) {
    bytes = bytes.substr(0, 1 << 16);
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos || bytes[begin] != '<') return false;
    // The root is the first element that is no declaration and no comment.
    for (std::size_t at = begin; at < bytes.size(); ++at) {
        if (bytes[at] != '<' || at + 1 == bytes.size()) continue;
        if (bytes.substr(at).starts_with("<!--")) {
            at = bytes.find("-->", at);
            if (at == std::string_view::npos) return false;
        } else if (bytes[at + 1] != '?' && bytes[at + 1] != '!' && bytes[at + 1] != '/') {
            std::string_view tag =
                bytes.substr(at + 1, bytes.find_first_of(" \t\r\n/>", at + 1) - at - 1);
            if (const std::size_t colon = tag.find(':'); colon != std::string_view::npos)
                tag.remove_prefix(colon + 1);
            return tag == "svg";
        }
    }
    return false;
}

Document readSvg(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    SvgDrawing drawing = readSvgShapes(bytes, name, options);
    out.note(drawing.scale);
    for (const auto& [what, count] : drawing.left_out)
        out.note("left out: " + what + " (" + std::to_string(count) + ')');
    writeLinePlan(std::move(drawing.shapes), {}, name, options, out);
    return out.take();
}

}  // namespace ispace
