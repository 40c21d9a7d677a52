// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/meshes/module/plain_text.h"

#include <algorithm>

namespace ispace::meshes {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool beginsNumber(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

/// Removes the blanks between a tag and a number.
std::optional<std::string> withoutBlanks(std::string_view xml) {
    std::string out;
    std::size_t copied = 0;
    for (std::size_t at = xml.find('>'); at != std::string_view::npos; at = xml.find('>', at)) {
        const std::size_t begin = ++at;
        while (at < xml.size() && isBlank(xml[at])) ++at;
        if (at == begin || at == xml.size() || !beginsNumber(xml[at])) continue;
        out += xml.substr(copied, begin - copied);
        copied = at;
    }
    if (copied == 0) return std::nullopt;
    out += xml.substr(copied);
    return out;
}

}  // namespace

std::optional<std::string> plainMeshText(MeshFormat format, std::string_view bytes) {
    if (format == MeshFormat::Collada) return withoutBlanks(bytes);
    constexpr std::size_t kBeginning = 4096;
    const bool is_plain = bytes.starts_with("solid") &&
                          bytes.substr(0, kBeginning).find("FACET") == std::string_view::npos;
    if (format != MeshFormat::Stl || !isTextStl(bytes) || is_plain) return std::nullopt;
    std::string text(bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size())));
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

}  // namespace ispace::meshes
