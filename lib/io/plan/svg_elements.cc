// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/svg.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "base/budget.h"
#include "base/message.h"
#include "base/number.h"
#include "io/plan/drawing_source.h"

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

/// Returns the point of `transform-origin` in pixels; std::nullopt for the default, and for shares
/// of boxes.
std::optional<Vec2> originOf(std::string_view text) {
    if (text.empty()) return std::nullopt;
    const auto numbers = tryNumbers(cssTransform(text));
    if (!numbers || numbers->size() < 2) return std::nullopt;
    return Vec2{(*numbers)[0], (*numbers)[1]};
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

SvgProperties svgProperties(pugi::xml_node node, const SvgSheet& sheet) {
    SvgProperties properties;
    properties.declare(node.attribute("style").value());
    sheet.apply(node, properties);
    for (std::size_t i = 0; i < SvgProperties::kNames.size(); ++i)
        properties.setIfUnset(static_cast<SvgProperty>(i),
                              trimmed(node.attribute(SvgProperties::kNames[i]).value()));
    return properties;
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
    const auto is_none = [](std::string_view value) {
        return value == "none" || value == "transparent";
    };
    if (const auto value = stated(SvgProperty::Visibility); !value.empty())
        style.visible = value == "visible";
    if (const auto value = stated(SvgProperty::Fill); !value.empty())
        style.no_fill = is_none(value);
    if (const auto value = stated(SvgProperty::Stroke); !value.empty()) {
        style.no_stroke = is_none(value);
        style.has_stroke = !style.no_stroke;
    }
    if (const auto value = stated(SvgProperty::FillOpacity); !value.empty())
        style.clear_fill = isSvgClear(value);
    if (const auto value = stated(SvgProperty::StrokeOpacity); !value.empty())
        style.clear_stroke = isSvgClear(value);
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
    element.properties = svgProperties(node, sheet);
    const std::string_view transform = element.properties[SvgProperty::Transform];
    element.transform = transform == "none" ? Affine() : parseSvgTransform(cssTransform(transform));
    if (const auto origin = originOf(element.properties[SvgProperty::TransformOrigin])) {
        const Affine there{{1, 0}, {0, 1}, *origin}, back{{1, 0}, {0, 1}, -1 * *origin};
        element.transform = there * element.transform * back;
    }
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
