// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of SVG: the properties, transforms, names and shapes that one element states, before it
// is placed.
#include "extensions/cad/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/budget.h"
#include "base/message.h"
#include "base/number.h"
#include "io/plan/drawing_source.h"

namespace ispace::cad {

namespace {

std::optional<std::vector<double>> tryNumbers(std::string_view text) {
    try {
        return parseSvgNumbers(text);
    } catch (const SvgError&) {
        return std::nullopt;
    }
}

/// Returns a length in pixels; std::nullopt for a percentage and for other text.
std::optional<double> tryLength(std::string_view text) {
    if (const auto numbers = tryNumbers(text); numbers && numbers->size() == 1)
        return numbers->front();
    try {
        if (const auto metres = parseSvgMetres(text)) return *metres / *parseSvgMetres("1");
    } catch (const SvgError&) {
    }
    return std::nullopt;
}

double radius(pugi::xml_node node, const char* key, double whole) {
    const double value = svgNumber(node, key, 0, whole);
    if (value < 0) throw SvgError(std::string(key) + " is " + formatDouble(value));
    return value;
}

/// Returns the value of `transform` as the attribute has it: without units, which CSS requires.
std::string cssTransform(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool follows_number =
            i > 0 && ((text[i - 1] >= '0' && text[i - 1] <= '9') || text[i - 1] == '.');
        const auto skips = [&](std::string_view unit) {
            if (!follows_number || !text.substr(i).starts_with(unit)) return false;
            i += unit.size() - 1;
            return true;
        };
        if (!skips("px") && !skips("deg")) plain += text[i];
    }
    return plain;
}

/// Returns true if an option names layers like this.
bool isNamed(const char* text, const ImportOptions& options) {
    return *text != '\0' &&
           (matchesLayer(options.door_layers, text) || matchesLayer(options.window_layers, text) ||
            matchesLayer(options.wall_layers, text));
}

}  // namespace

std::string_view svgName(pugi::xml_node node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

SvgProperties svgProperties(pugi::xml_node node, const SvgSheet& sheet, std::size_t* matching) {
    SvgProperties properties;
    properties.declare(node.attribute("style").value());
    const std::size_t units = sheet.apply(node, properties);
    if (matching != nullptr) *matching = units;
    for (std::size_t i = 0; i < SvgProperties::kNames.size(); ++i)
        properties.setIfUnset(static_cast<SvgProperty>(i),
                              trimmed(node.attribute(SvgProperties::kNames[i]).value()));
    return properties;
}

bool isSvgNone(std::string_view paint) {
    if (paint == "none" || paint == "transparent") return true;
    if (paint.starts_with('#'))
        return (paint.size() == 5 && paint.ends_with('0')) ||
               (paint.size() == 9 && paint.ends_with("00"));
    // rgba(0, 0, 0, 0), hsl(0 0% 0% / 0%)
    const std::size_t open = paint.find('(');
    if (open == std::string_view::npos || !paint.ends_with(')')) return false;
    const std::string_view name = paint.substr(0, open);
    const bool is_color = name == "rgb" || name == "rgba" || name == "hsl" || name == "hsla";
    const std::string_view values = paint.substr(open + 1, paint.size() - open - 2);
    const std::size_t slash = values.find('/'), last = values.rfind(',');
    const auto commas = std::count(values.begin(), values.end(), ',');
    const std::size_t before = slash != std::string_view::npos ? slash
                               : commas == 3                   ? last
                                                               : values.size();
    return is_color && before < values.size() && isSvgClear(trimmed(values.substr(before + 1)));
}

bool isSvgClear(std::string_view opacity) {
    if (opacity.ends_with('%')) opacity.remove_suffix(1);
    const auto value = parseDouble(opacity);
    return value && *value <= 0;
}

SvgStyle svgStyle(SvgStyle style, const SvgProperties& properties) {
    const auto stated = [&](SvgProperty key) {
        const std::string_view value = properties[key];
        return value == "inherit" ? std::string_view() : value;
    };
    if (const auto value = stated(SvgProperty::Visibility); !value.empty())
        style.visible = value == "visible";
    if (const auto value = stated(SvgProperty::Fill); !value.empty())
        style.no_fill = isSvgNone(value);
    if (const auto value = stated(SvgProperty::Stroke); !value.empty()) {
        style.no_stroke = isSvgNone(value);
        style.has_stroke = !style.no_stroke;
    }
    if (const auto value = stated(SvgProperty::FillOpacity); !value.empty())
        style.clear_fill = isSvgClear(value);
    if (const auto value = stated(SvgProperty::StrokeOpacity); !value.empty())
        style.clear_stroke = isSvgClear(value);
    if (const auto value = stated(SvgProperty::StrokeDasharray); !value.empty()) {
        // Zeros, and words that are no lengths, draw a whole line.
        style.is_dashed = value.find_first_of("123456789") != std::string_view::npos;
    }
    if (const auto value = stated(SvgProperty::StrokeWidth); !value.empty())
        if (const auto width = tryLength(value)) style.stroke_width = *width;
    return style;
}

SvgNames SvgNames::with(const SvgNames& own) const {
    return {own.option != nullptr ? own.option : option, own.walls != nullptr ? own.walls : walls,
            own.layer != nullptr ? own.layer : layer, group != nullptr ? group : own.group,
            own.meaning != nullptr ? own.meaning : (own.walls != nullptr ? nullptr : meaning)};
}

const char* SvgNames::planLayer() const {
    for (const char* name : {option, meaning, layer, group})
        if (name != nullptr) return name;
    return "(none)";
}

SvgElement readSvgElement(pugi::xml_node node, const SvgSheet& sheet,
                          const ImportOptions& options) {
    SvgElement element;
    element.properties = svgProperties(node, sheet, &element.matching);
    const std::string_view transform = element.properties[SvgProperty::Transform];
    element.transform = transform == "none" ? Affine() : parseSvgTransform(cssTransform(transform));
    SvgNames& names = element.names;
    const pugi::xml_attribute label = node.attribute("inkscape:label"), id = node.attribute("id");
    for (const char* text : {label.value(), id.value()}) {
        if (names.option == nullptr && isNamed(text, options)) names.option = text;
        if (names.walls == nullptr && isWallName(text)) names.walls = text;
    }
    if (const char* const name = (label ? label : id).value(); *name != '\0') {
        if (std::string_view(node.attribute("inkscape:groupmode").value()) == "layer")
            names.layer = name;
        if (svgName(node) == "g") {
            names.group = name;
            if (names.walls == nullptr &&
                (isThingName(name) || isDoorName(name) || isWindowName(name)))
                names.meaning = name;
        }
    }
    // Others are parsed each time, or passed over in the search for one that is.
    constexpr std::array<std::string_view, 3> kParsedOnce{"style", "class", "transform"};
    std::size_t bytes = 0;
    for (const pugi::xml_attribute attribute : node.attributes())
        if (std::find(kParsedOnce.begin(), kParsedOnce.end(), attribute.name()) ==
            kParsedOnce.end())
            bytes += 8 + std::string_view(attribute.value()).size();
    element.units = Budget::unitsOf(bytes);
    return element;
}

double svgNumber(pugi::xml_node node, const char* key, double standard, double whole) {
    const std::string_view text = trimmed(node.attribute(key).value());
    if (text.empty()) return standard;
    if (const auto numbers = tryNumbers(text); numbers && numbers->size() == 1)
        return numbers->front();
    if (whole > 0 && text.ends_with('%'))
        if (const auto share = parseDouble(trimmed(text.substr(0, text.size() - 1))))
            return whole * *share / 100;
    const auto metres = parseSvgMetres(text);
    if (!metres)
        throw SvgError(std::string(key) + ": found " + excerpt(text) + ", wanted a number");
    return *metres / *parseSvgMetres("1");  // 5mm is so many units of a pixel
}

std::optional<Vec2> svgOrigin(std::string_view text, const SvgBox& view) {
    std::array<std::optional<double>, 2> place;
    std::size_t taken = 0;
    while (!(text = trimmed(text)).empty() && taken < 2) {
        const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n,"));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        const bool is_vertical = word == "top" || word == "bottom" || taken == 1;
        const double whole = is_vertical ? view.height : view.width;
        std::optional<double> value = tryLength(word);
        if (word == "left" || word == "top") value = 0;
        if (word == "center") value = whole / 2;
        if (word == "right" || word == "bottom") value = whole;
        if (word.ends_with('%'))
            if (const auto share = parseDouble(word.substr(0, word.size() - 1)))
                value = whole * *share / 100;
        if (!value) return std::nullopt;
        // "top left" names y first.
        const bool is_swapped = taken == 1 && (word == "left" || word == "right");
        if (is_swapped) place[1] = place[0];
        place[is_swapped ? 0 : (word == "top" || word == "bottom" ? 1 : taken)] = value;
        ++taken;
    }
    if (taken == 0) return std::nullopt;
    return Vec2{place[0].value_or(view.width / 2), place[1].value_or(view.height / 2)};
}

std::optional<SvgBox> svgViewBox(pugi::xml_node node) {
    const pugi::xml_attribute attribute = node.attribute("viewBox");
    if (!attribute) return std::nullopt;
    const std::vector<double> v = parseSvgNumbers(attribute.value());
    if (v.size() != 4 || !(v[2] > 0) || !(v[3] > 0))
        throw SvgError("viewBox: wanted x, y, width and height");
    return SvgBox{v[0], v[1], v[2], v[3]};
}

std::vector<SvgSubpath> svgPaths(pugi::xml_node node, std::string_view kind, const SvgBox& view) {
    const double w = view.width, h = view.height, diagonal = std::hypot(w, h) / std::numbers::sqrt2;
    if (kind == "path") return parseSvgPath(node.attribute("d").value());
    if (kind == "line") {
        const Point2 from{svgNumber(node, "x1", 0, w), svgNumber(node, "y1", 0, h)};
        return {
            {from, {SvgLine{{svgNumber(node, "x2", 0, w), svgNumber(node, "y2", 0, h)}}}, false}};
    }
    if (kind == "circle" || kind == "ellipse") {
        const double rx = kind == "circle" ? radius(node, "r", diagonal) : radius(node, "rx", w);
        const double ry = kind == "circle" ? rx : radius(node, "ry", h);
        if (rx == 0 || ry == 0) return {};
        return {svgEllipse({svgNumber(node, "cx", 0, w), svgNumber(node, "cy", 0, h)}, rx, ry)};
    }
    if (kind == "rect") {
        const double width = radius(node, "width", w), height = radius(node, "height", h);
        if (width == 0 || height == 0) return {};
        const bool has_rx = node.attribute("rx"), has_ry = node.attribute("ry");
        return {svgRectangle({svgNumber(node, "x", 0, w), svgNumber(node, "y", 0, h)}, width,
                             height, radius(node, has_rx ? "rx" : "ry", has_rx ? w : h),
                             radius(node, has_ry ? "ry" : "rx", has_ry ? h : w))};
    }
    const std::vector<double> numbers = parseSvgNumbers(node.attribute("points").value());
    if (numbers.size() % 2 != 0) throw SvgError("points: a number is missing");
    if (numbers.size() < 4) return {};
    SvgSubpath path{{numbers[0], numbers[1]}, {}, kind == "polygon"};
    for (std::size_t i = 2; i < numbers.size(); i += 2)
        path.pieces.emplace_back(SvgLine{{numbers[i], numbers[i + 1]}});
    return {path};
}

}  // namespace ispace::cad
