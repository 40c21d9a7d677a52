// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of DXF import: builds drawings from entities.
#pragma once

#include <initializer_list>
#include <string>
#include <type_traits>

#include "base/number.h"

namespace ispace::cad {

inline std::string group(int code, const std::string& value) {
    return "  " + std::to_string(code) + '\n' + value + '\n';
}
inline std::string group(int code, const char* value) { return group(code, std::string(value)); }
template <typename Number>
requires std::is_arithmetic_v<Number> std::string group(int code, Number value) {
    return group(code, formatDouble(static_cast<double>(value)));
}

inline std::string line(const std::string& layer, double x0, double y0, double x1, double y1) {
    return group(0, "LINE") + group(8, layer) + group(10, x0) + group(20, y0) + group(30, 0.0) +
           group(11, x1) + group(21, y1) + group(31, 0.0);
}

inline std::string arc(const std::string& layer, double x, double y, double radius, double from,
                       double to) {
    return group(0, "ARC") + group(8, layer) + group(10, x) + group(20, y) + group(40, radius) +
           group(50, from) + group(51, to);
}

struct DxfCorner {
    double x, y, bulge = 0;
};

inline std::string polyline(const std::string& layer, bool closed,
                            std::initializer_list<DxfCorner> corners) {
    std::string text = group(0, "LWPOLYLINE") + group(8, layer) +
                       group(90, std::to_string(corners.size())) + group(70, closed ? "1" : "0");
    for (const auto& [x, y, bulge] : corners) {
        text += group(10, x) + group(20, y);
        if (bulge != 0) text += group(42, bulge);
    }
    return text;
}

/// Writes weights only if they are given.
inline std::string spline(const std::string& layer, int degree, std::initializer_list<double> knots,
                          std::initializer_list<DxfCorner> controls,
                          std::initializer_list<double> weights = {}) {
    std::string text = group(0, "SPLINE") + group(8, layer) + group(70, "8") +
                       group(71, std::to_string(degree)) + group(72, std::to_string(knots.size())) +
                       group(73, std::to_string(controls.size())) + group(74, "0") +
                       group(42, "1e-9") + group(43, "1e-9");
    for (const double knot : knots) text += group(40, knot);
    for (const double weight : weights) text += group(41, weight);
    for (const auto& [x, y, bulge] : controls)
        text += group(10, x) + group(20, y) + group(30, "0.0");
    return text;
}

/// Writes the same as POLYLINE, VERTEX, SEQEND.
inline std::string oldPolyline(const std::string& layer, bool closed,
                               std::initializer_list<DxfCorner> corners) {
    std::string text = group(0, "POLYLINE") + group(8, layer) + group(66, "1") + group(10, 0.0) +
                       group(20, 0.0) + group(70, closed ? "1" : "0");
    for (const auto& [x, y, bulge] : corners)
        text +=
            group(0, "VERTEX") + group(8, layer) + group(10, x) + group(20, y) + group(42, bulge);
    text += group(0, "VERTEX") + group(8, layer) + group(10, 77) + group(20, 77) + group(70, "16");
    return text + group(0, "SEQEND");
}

inline std::string rectangle(const std::string& layer, double x0, double y0, double x1, double y1) {
    return polyline(layer, true, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

inline std::string block(const std::string& name, double x, double y, const std::string& entities) {
    return group(0, "BLOCK") + group(8, "0") + group(2, name) + group(70, "0") + group(10, x) +
           group(20, y) + group(3, name) + entities + group(0, "ENDBLK") + group(8, "0");
}

inline std::string insert(const std::string& name, const std::string& layer, double x, double y,
                          const std::string& more = "") {
    return group(0, "INSERT") + group(8, layer) + group(2, name) + group(10, x) + group(20, y) +
           more;
}

inline std::string layer(const std::string& name, int color, int flags) {
    return group(0, "LAYER") + group(2, name) + group(70, std::to_string(flags)) +
           group(62, std::to_string(color));
}

/// Builds a file of these entities, in millimetres unless `units` ($INSUNITS) says otherwise.
/// Without blocks and layers the first entity begins in line 16.
inline std::string drawing(const std::string& entities, const std::string& blocks = "",
                           int units = 4, const std::string& layers = "") {
    const auto section = [](const std::string& name, const std::string& content) {
        return group(0, "SECTION") + group(2, name) + content + group(0, "ENDSEC");
    };
    std::string text = group(0, "SECTION") + group(2, "HEADER") + group(9, "$INSUNITS") +
                       group(70, std::to_string(units));
    text += group(0, "ENDSEC");
    if (!layers.empty()) text += section("TABLES", layers);
    if (!blocks.empty()) text += section("BLOCKS", blocks);
    return text + section("ENTITIES", entities) + group(0, "EOF");
}

}  // namespace ispace::cad
