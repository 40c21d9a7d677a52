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

std::string withoutComments(std::string_view css) {
    std::string text;
    while (!css.empty()) {
        const std::size_t begin = css.find("/*");
        text += css.substr(0, begin);
        if (begin == std::string_view::npos) break;
        const std::size_t end = css.find("*/", begin + 2);
        css.remove_prefix(end == std::string_view::npos ? css.size() : end + 2);
    }
    return text;
}

/// Returns true if an option names layers like this.
bool isNamed(const char* text, const ImportOptions& options) {
    return *text != '\0' &&
           (matchesLayer(options.door_layers, text) || matchesLayer(options.window_layers, text) ||
            matchesLayer(options.wall_layers, text));
}

/// Removes and returns the text before the mark, which is removed, too.
std::string_view takeUntil(std::string_view& rest, char mark) {
    const std::string_view part = rest.substr(0, rest.find(mark));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    return part;
}

/// Calls visit(std::string) for the selectors that match an element, the strongest first.
template <typename Visit>
void forEachSelector(pugi::xml_node node, Visit visit) {
    visit('#' + std::string(node.attribute("id").value()));
    for (std::string_view names = node.attribute("class").value(); !names.empty();)
        visit('.' + std::string(takeUntil(names, ' ')));
    visit(std::string(svgName(node)));
}

}  // namespace

std::string_view svgName(pugi::xml_node node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

void SvgProperties::declare(std::string_view declarations) {
    while (!declarations.empty()) {
        const std::string_view part = takeUntil(declarations, ';');
        const std::size_t colon = part.find(':');
        if (colon == std::string_view::npos) continue;
        const auto name = std::find(kNames.begin(), kNames.end(), trimmed(part.substr(0, colon)));
        if (name != kNames.end())
            values_[static_cast<std::size_t>(name - kNames.begin())] =
                trimmed(part.substr(colon + 1));
    }
}

void SvgProperties::addWeaker(const SvgProperties& others) {
    for (std::size_t i = 0; i < values_.size(); ++i)
        if (values_[i].empty()) values_[i] = others.values_[i];
}

void SvgProperties::addStronger(const SvgProperties& others) {
    SvgProperties both = others;
    both.addWeaker(*this);
    *this = both;
}

void SvgSheet::announce(pugi::xml_node node) {
    forEachSelector(node, [this](const std::string& name) { announced_[slot(name)] = true; });
}

void SvgSheet::add(std::string_view css) {
    std::string_view rest = texts_.emplace_back(withoutComments(css));
    while (!rest.empty()) {
        std::string_view selectors = takeUntil(rest, '{');
        SvgProperties declared;
        declared.declare(takeUntil(rest, '}'));
        if (declared.isEmpty()) continue;
        while (!selectors.empty())
            if (const std::string_view name = trimmed(takeUntil(selectors, ','));
                announced_[slot(name)])
                rules_[std::string(name)].addStronger(declared);
    }
}

void SvgSheet::apply(pugi::xml_node node, SvgProperties& properties) const {
    if (rules_.empty()) return;
    forEachSelector(node, [&](const std::string& name) {
        if (const auto rule = rules_.find(name); rule != rules_.end())
            properties.addWeaker(rule->second);
    });
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
    return style;
}

SvgNames SvgNames::with(const SvgNames& own) const {
    return {own.option != nullptr ? own.option : option, own.walls != nullptr ? own.walls : walls,
            own.layer != nullptr ? own.layer : layer, group != nullptr ? group : own.group};
}

const char* SvgNames::planLayer() const {
    for (const char* name : {option, layer, group})
        if (name != nullptr) return name;
    return "(none)";
}

SvgElement readSvgElement(pugi::xml_node node, const SvgSheet& sheet,
                          const ImportOptions& options) {
    SvgElement element;
    element.properties = svgProperties(node, sheet);
    element.transform = parseSvgTransform(node.attribute("transform").value());
    SvgNames& names = element.names;
    const pugi::xml_attribute label = node.attribute("inkscape:label"), id = node.attribute("id");
    for (const char* text : {label.value(), id.value()}) {
        if (names.option == nullptr && isNamed(text, options)) names.option = text;
        if (names.walls == nullptr && isWallName(text)) names.walls = text;
    }
    if (const char* const name = (label ? label : id).value(); *name != '\0') {
        if (std::string_view(node.attribute("inkscape:groupmode").value()) == "layer")
            names.layer = name;
        if (svgName(node) == "g") names.group = name;
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
