// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>

#include "env/body.h"
#include "env/environment.h"

namespace ispace {

/// Measures of an environment, for people and for `envc --info --json`.
struct EnvironmentInfo {
    std::string digest;
    Box2 limits;
    double indoor_area = 0;             ///< m2
    double free_area = 0;               ///< m2, at kScanHeight
    double height = 0;                  ///< the highest wall, m
    double perimeter = 0;               ///< of the indoor region, holes included, m
    std::map<std::string, int> counts;  ///< records by keyword
    std::size_t triangles = 0;          ///< of bodies and floor
};

EnvironmentInfo describe(const Environment& environment, std::span<const Record> records,
                         const std::string& digest);

/// One JSON object and a newline, schema ispace-info/1.
std::string infoJson(const EnvironmentInfo& info);
std::string infoText(const EnvironmentInfo& info);

/// Findings about the shape of a record beyond its schema and its wall lines: zones and closed
/// fences that cross themselves, zones without extent, bodies too small for their place, files of
/// meshes that are not loaded or hold no body.
void checkShape(const Record& record, const Body& body, Diagnostics& findings);

/// "(4.1, 2.0)": a place as people find it on a plan, to the centimetre.
std::string placeText(Point2 p);

/// "wall w3", "door d1": how findings name an element.
std::string nameOf(const Element& element);

/// A length as findings give it: at least millimetres and at least two digits: "0.12", "0.0012".
std::string lengthText(double length);

}  // namespace ispace
