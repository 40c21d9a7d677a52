// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/svg_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/number.h"

namespace ispace {

namespace {

std::string escapedXml(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '&':
                result += "&amp;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string svgColor(Color color) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string result = "#";
    for (const double part : {color.red, color.green, color.blue}) {
        const auto value = static_cast<unsigned>(std::lround(std::clamp(part, 0.0, 1.0) * 255));
        result += kDigits[value / 16];
        result += kDigits[value % 16];
    }
    return result;
}

}  // namespace

void appendSvgText(std::string& out, Point2 begin, double length, const std::string& text,
                   const TextStyle& style, bool halo) {
    if (text.empty()) return;
    const Color color = halo ? *style.halo : style.color;
    const auto add = [&out](std::string_view name, std::string_view value) {
        out.append(" ").append(name).append("=\"").append(value).append("\"");
    };
    out += "<text";
    add("x", formatFixed(begin.x, 2));
    add("y", formatFixed(begin.y, 2));
    add("font-size", formatFixed(style.size, 2));
    if (style.bold) add("font-weight", "bold");
    add("textLength", formatFixed(length, 2));
    add("lengthAdjust", "spacingAndGlyphs");
    add("fill", svgColor(color));
    if (color.alpha < 1) add("fill-opacity", formatFixed(color.alpha, 2));
    if (halo) {
        add("stroke", svgColor(color));
        add("stroke-width", formatFixed(style.size / 4, 2));
        if (color.alpha < 1) add("stroke-opacity", formatFixed(color.alpha, 2));
        add("stroke-linejoin", "round");
        add("aria-hidden", "true");
    }
    out.append(">").append(escapedXml(text)).append("</text>\n");
}

std::string withTexts(std::string svg, const std::string& texts) {
    if (texts.empty()) return svg;
    const std::string group =
        "<g font-family=\"DejaVu Sans, Verdana, sans-serif\" xml:space=\"preserve\">\n" + texts +
        "</g>\n";
    return svg.insert(svg.rfind("</svg>"), group);
}

std::string renumberSurfaces(const std::string& svg) {
    constexpr std::string_view kName = "surface";
    std::string result;
    std::map<std::string, std::size_t> numbers;
    std::size_t done = 0;
    for (std::size_t at; (at = svg.find(kName, done)) != std::string::npos;) {
        std::size_t end = at + kName.size();
        while (end < svg.size() && std::isdigit(static_cast<unsigned char>(svg[end])) != 0) ++end;
        result.append(svg, done, at + kName.size() - done);
        const std::string old = svg.substr(at + kName.size(), end - at - kName.size());
        if (!old.empty())
            result += std::to_string(numbers.emplace(old, numbers.size()).first->second);
        done = end;
    }
    return result.append(svg, done);
}

}  // namespace ispace
