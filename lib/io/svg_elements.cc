// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/svg_elements.h"

#include <algorithm>
#include <string>

#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

std::optional<std::vector<double>> tryNumbers(std::string_view text) {
    try {
        return parseSvgNumbers(text);
    } catch (const SvgError&) {
        return std::nullopt;
    }
}

double radius(pugi::xml_node node, const char* key) {
    const double value = svgNumber(node, key);
    if (value < 0) throw SvgError(std::string(key) + " is " + formatDouble(value));
    return value;
}

/// Bytes; rules of drawings are short, hostile ones may be long.
constexpr std::size_t kMaxRule = 4096;

/// The value of a property in `a: b; c: d`, or ""; the last one counts.
std::string_view declared(std::string_view rest, std::string_view key) {
    std::string_view value;
    while (!rest.empty()) {
        const std::string_view part = rest.substr(0, rest.find(';'));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        const std::size_t colon = part.find(':');
        if (colon != std::string_view::npos && trimmed(part.substr(0, colon)) == key)
            value = trimmed(part.substr(colon + 1));
    }
    return value;
}

}  // namespace

std::string_view svgName(pugi::xml_node node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view svgProperty(pugi::xml_node node, std::string_view key, const SvgSheet& sheet) {
    if (const auto own = declared(node.attribute("style").value(), key); !own.empty()) return own;
    if (const auto ruled = sheet.property(node, key); !ruled.empty()) return ruled;
    return trimmed(node.attribute(std::string(key).c_str()).value());
}

void SvgSheet::add(std::string_view css) {
    std::string text(css);
    for (std::size_t at = 0; (at = text.find("/*", at)) != std::string::npos;)
        text.erase(at, std::min(text.find("*/", at), text.size() - 2) + 2 - at);
    for (std::string_view rest = text; !rest.empty();) {
        std::string_view selectors = rest.substr(0, rest.find('{'));
        rest.remove_prefix(std::min(selectors.size() + 1, rest.size()));
        const std::string_view body = rest.substr(0, rest.find('}'));
        rest.remove_prefix(std::min(body.size() + 1, rest.size()));
        while (!selectors.empty()) {
            const std::string_view part = selectors.substr(0, selectors.find(','));
            selectors.remove_prefix(std::min(part.size() + 1, selectors.size()));
            std::string& rule = rules_[std::string(trimmed(part))];
            if (rule.size() + body.size() < kMaxRule) (rule += body) += ';';
        }
    }
}

std::string_view SvgSheet::property(pugi::xml_node node, std::string_view key) const {
    if (rules_.empty()) return {};
    const auto find = [&](const std::string& selector) {
        const auto rule = rules_.find(selector);
        return rule == rules_.end() ? std::string_view() : declared(rule->second, key);
    };
    if (const auto value = find('#' + std::string(node.attribute("id").value())); !value.empty())
        return value;
    for (std::string_view names = node.attribute("class").value(); !names.empty();) {
        const std::string_view name = names.substr(0, names.find(' '));
        names.remove_prefix(std::min(name.size() + 1, names.size()));
        if (const auto value = find('.' + std::string(name)); !value.empty()) return value;
    }
    return find(std::string(svgName(node)));
}

SvgStyle svgStyle(pugi::xml_node node, SvgStyle style, const SvgSheet& sheet) {
    if (const auto value = svgProperty(node, "visibility", sheet);
        !value.empty() && value != "inherit")
        style.visible = value == "visible";
    if (const auto value = svgProperty(node, "fill", sheet); !value.empty() && value != "inherit")
        style.no_fill = value == "none" || value == "transparent";
    if (const auto value = svgProperty(node, "stroke", sheet);
        !value.empty() && value != "inherit") {
        style.no_stroke = value == "none" || value == "transparent";
        style.has_stroke = !style.no_stroke;
    }
    return style;
}

double svgNumber(pugi::xml_node node, const char* key, double standard) {
    const std::string_view text = trimmed(node.attribute(key).value());
    if (text.empty()) return standard;
    if (const auto numbers = tryNumbers(text); numbers && numbers->size() == 1)
        return numbers->front();
    const auto metres = parseSvgMetres(text);
    if (!metres)
        throw SvgError(std::string(key) + ": found " + excerpt(text) + ", wanted a number");
    return *metres / *parseSvgMetres("1");  // 5mm is so many units of a pixel
}

std::optional<SvgBox> svgViewBox(pugi::xml_node node) {
    const pugi::xml_attribute attribute = node.attribute("viewBox");
    if (!attribute) return std::nullopt;
    const std::vector<double> v = parseSvgNumbers(attribute.value());
    if (v.size() != 4 || !(v[2] > 0) || !(v[3] > 0))
        throw SvgError("viewBox: wanted x, y, width and height");
    return SvgBox{v[0], v[1], v[2], v[3]};
}

std::vector<SvgSubpath> svgPaths(pugi::xml_node node, std::string_view kind) {
    if (kind == "path") return parseSvgPath(node.attribute("d").value());
    if (kind == "line") {
        const Point2 from{svgNumber(node, "x1"), svgNumber(node, "y1")};
        return {{from, {SvgLine{{svgNumber(node, "x2"), svgNumber(node, "y2")}}}, false}};
    }
    if (kind == "circle" || kind == "ellipse") {
        const double rx = radius(node, kind == "circle" ? "r" : "rx");
        const double ry = radius(node, kind == "circle" ? "r" : "ry");
        if (rx == 0 || ry == 0) return {};
        return {svgEllipse({svgNumber(node, "cx"), svgNumber(node, "cy")}, rx, ry)};
    }
    if (kind == "rect") {
        const double width = radius(node, "width"), height = radius(node, "height");
        if (width == 0 || height == 0) return {};
        const bool has_rx = node.attribute("rx"), has_ry = node.attribute("ry");
        return {svgRectangle({svgNumber(node, "x"), svgNumber(node, "y")}, width, height,
                             radius(node, has_rx ? "rx" : "ry"),
                             radius(node, has_ry ? "ry" : "rx"))};
    }
    const std::vector<double> numbers = parseSvgNumbers(node.attribute("points").value());
    if (numbers.size() % 2 != 0) throw SvgError("points: a number is missing");
    if (numbers.size() < 4) return {};
    SvgSubpath path{{numbers[0], numbers[1]}, {}, kind == "polygon"};
    for (std::size_t i = 2; i < numbers.size(); i += 2)
        path.pieces.emplace_back(SvgLine{{numbers[i], numbers[i + 1]}});
    return {path};
}

}  // namespace ispace
