// SPDX-License-Identifier: GPL-3.0-or-later
// Units (IfcUnitAssignment), placements and transformations of IFC2X3 and IFC4, as right-handed
// frames in metres: the z of the file holds, its x is turned to be square to it. Units of time,
// mass and the like are not read. Placements in a loop are UnreadGeometry.
#include "extensions/ifc/reader/ifc_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ispace::ifc {

namespace {

double prefixOf(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, double>, 16> kPrefixes{{{"EXA", 1e18},
                                                                             {"PETA", 1e15},
                                                                             {"TERA", 1e12},
                                                                             {"GIGA", 1e9},
                                                                             {"MEGA", 1e6},
                                                                             {"KILO", 1e3},
                                                                             {"HECTO", 1e2},
                                                                             {"DECA", 1e1},
                                                                             {"DECI", 1e-1},
                                                                             {"CENTI", 1e-2},
                                                                             {"MILLI", 1e-3},
                                                                             {"MICRO", 1e-6},
                                                                             {"NANO", 1e-9},
                                                                             {"PICO", 1e-12},
                                                                             {"FEMTO", 1e-15},
                                                                             {"ATTO", 1e-18}}};
    for (const auto& [name, factor] : kPrefixes)
        if (name == word) return factor;
    return 1;
}

/// Factor of IfcSIUnit or IfcConversionBasedUnit to the SI unit without prefix; 1 for others.
double factorOf(const StepFile& file, StepId id, int depth = 0) {
    const StepInstance unit = file.read(id);
    if (unit.type == "IFCSIUNIT") {
        const double prefix = prefixOf(unit[2].word());
        return unit[3].word() == "SQUARE_METRE" ? prefix * prefix : prefix;
    }
    if (!unit.type.starts_with("IFCCONVERSIONBASEDUNIT") || depth > kMaxIfcDepth) return 1;
    const StepInstance measure = file.read(unit[3].reference());
    const double factor =
        measure[0].number().value_or(1) * factorOf(file, measure[1].reference(), depth + 1);
    return factor > 0 && std::isfinite(factor) ? factor : 1;
}

/// Builds the right-handed frame with this z and with x as near to `x` as possible.
IfcFrame orthonormal(Vec3 z, Vec3 x, Point3 origin) {
    IfcFrame frame;
    frame.origin = origin;
    if (z = unitOf(z); length(z) > 0) frame.z = z;
    Vec3 side = unitOf(x + -dot(x, frame.z) * frame.z);
    if (!(length(side) > 0))  // parallel: any other
        side = unitOf(cross(std::abs(frame.z.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, frame.z));
    frame.x = side;
    frame.y = cross(frame.z, frame.x);
    return frame;
}

}  // namespace

Vec3 unitOf(Vec3 v) {
    const double l = length(v);
    return l > 1e-12 && std::isfinite(l) ? 1 / l * v : Vec3{};
}

IfcUnits readIfcUnits(const StepFile& file) {
    IfcUnits units;
    const auto projects = file.ofType("IFCPROJECT");
    if (projects.empty()) return units;
    const StepInstance assignment = file.read(file.read(projects.front())[8].reference());
    for (const StepValue& value : assignment[0].list()) {
        const StepId id = value.reference();
        const std::string_view kind = file.read(id)[1].word();
        if (kind == "LENGTHUNIT") units.length = factorOf(file, id);
        if (kind == "AREAUNIT") units.area = factorOf(file, id);
        if (kind == "PLANEANGLEUNIT") units.angle = factorOf(file, id);
    }
    return units;
}

double IfcFrames::length(const StepValue& value) const {
    const auto number = value.number();
    if (!number) throw UnreadGeometry("a number that is missing");
    return *number * units_.length;
}

double IfcFrames::length(const StepValue& value, double standard) const {
    return value.isNull() ? standard : length(value);
}

Point3 IfcFrames::coordinates(const StepValue& list) const {
    const std::vector<StepValue> values = list.list();
    if (values.size() < 2) throw UnreadGeometry("a point without coordinates");
    return {length(values[0]), length(values[1]), values.size() > 2 ? length(values[2]) : 0};
}

Point3 IfcFrames::point(StepId id) const { return coordinates(file_.read(id)[0]); }

Vec3 IfcFrames::direction(StepId id, Vec3 standard) const {
    if (id == 0) return standard;
    const std::vector<StepValue> ratios = file_.read(id)[0].list();
    Vec3 v;
    if (!ratios.empty()) v.x = ratios[0].number().value_or(0);
    if (ratios.size() > 1) v.y = ratios[1].number().value_or(0);
    if (ratios.size() > 2) v.z = ratios[2].number().value_or(0);
    return v == Vec3{} ? standard : v;
}

IfcFrame IfcFrames::axes(StepId id) const {
    if (id == 0) return {};
    const StepInstance axes = file_.read(id);
    const Point3 origin = axes[0].isNull() ? Point3{} : point(axes[0].reference());
    const bool is_flat = axes.type == "IFCAXIS2PLACEMENT2D";
    const Vec3 z = is_flat ? Vec3{0, 0, 1} : direction(axes[1].reference(), {0, 0, 1});
    return orthonormal(z, direction(axes[is_flat ? 1 : 2].reference(), {1, 0, 0}), origin);
}

IfcFrame IfcFrames::transformation(StepId id) const {
    const StepInstance map = file_.read(id);
    if (!map.type.starts_with("IFCCARTESIANTRANSFORMATIONOPERATOR"))
        throw UnreadGeometry(std::string(map.type.empty() ? "a missing instance" : map.type));
    const bool is_flat = map.type.find("2D") != std::string_view::npos;
    const double scale = map[3].number().value_or(1);
    const Vec3 z = is_flat ? Vec3{0, 0, 1} : direction(map[4].reference(), {0, 0, 1});
    IfcFrame frame = orthonormal(z, direction(map[0].reference(), {1, 0, 0}),
                                 map[2].isNull() ? Point3{} : point(map[2].reference()));
    // Mirrored, or without its third axis.
    const Vec3 y = direction(map[1].reference(), frame.y);
    if (!is_flat && map[4].isNull() && !map[0].isNull() && !map[1].isNull())
        frame = orthonormal(cross(frame.x, y), frame.x, frame.origin);
    if (dot(y, frame.y) < 0) frame.y = -frame.y;
    const bool is_uneven = map.type.ends_with("NONUNIFORM");
    frame.x = scale * frame.x;
    frame.y = (is_uneven ? map[is_flat ? 4 : 5].number().value_or(scale) : scale) * frame.y;
    frame.z = (is_uneven && !is_flat ? map[6].number().value_or(scale) : scale) * frame.z;
    return frame;
}

IfcFrame IfcFrames::placement(StepId id, int depth) {
    if (id == 0) return {};
    if (depth > kMaxIfcDepth) throw UnreadGeometry("placements in a loop");
    if (const auto known = placements_.find(id); known != placements_.end()) return known->second;
    const StepInstance local = file_.read(id);
    if (local.type.empty()) throw UnreadGeometry("a missing placement");
    if (local.type != "IFCLOCALPLACEMENT") throw UnreadGeometry(std::string(local.type));
    const IfcFrame frame = placement(local[0].reference(), depth + 1) * axes(local[1].reference());
    placements_.emplace(id, frame);
    return frame;
}

namespace {

constexpr int kMaxHeight = 100;  // of the tree

}  // namespace

IfcTree::IfcTree(const StepFile& file) : file_(file) {
    const auto relate = [&](std::string_view type, std::size_t parent, std::size_t children,
                            auto add) {
        for (const StepId id : file.ofType(type)) {
            const StepInstance relation = file.read(id);
            const StepId above = relation[parent].reference();
            if (const StepId one = relation[children].reference(); one != 0) add(above, one);
            for (const StepValue& child : relation[children].list()) add(above, child.reference());
        }
    };
    const auto add_parent = [this](StepId above, StepId child) {
        parent_.try_emplace(child, above);
    };
    relate("IFCRELAGGREGATES", 4, 5, [&](StepId above, StepId child) {
        add_parent(above, child);
        wholes_.insert(above);
        if (whole_.try_emplace(child, above).second) parts_.push_back(child);
    });
    relate("IFCRELNESTS", 4, 5, add_parent);
    relate("IFCRELCONTAINEDINSPATIALSTRUCTURE", 5, 4, add_parent);
    relate("IFCRELVOIDSELEMENT", 4, 5, [&](StepId host, StepId hole) {
        host_.try_emplace(hole, host);
        add_parent(host, hole);
    });
    relate("IFCRELFILLSELEMENT", 4, 5, [&](StepId hole, StepId door) {
        filler_.try_emplace(hole, door);
        if (!file.typeOf(hole).empty()) filled_.try_emplace(door, hole);
        add_parent(hole, door);
    });
    relate("IFCRELDEFINESBYPROPERTIES", 5, 4, [&](StepId definition, StepId object) {
        if (file.typeOf(object) == "IFCSPACE") definitions_[object].push_back(definition);
    });
}

StepId IfcTree::above(StepId id, std::string_view type) const {
    for (int i = 0; i < kMaxHeight; ++i) {
        const auto parent = parent_.find(id);
        if (parent == parent_.end()) return 0;
        id = parent->second;
        if (file_.typeOf(id) == type) return id;
    }
    return 0;
}

bool IfcTree::isPartOfWall(StepId id) const {
    for (int i = 0; i < kMaxHeight; ++i) {
        const auto whole = whole_.find(id);
        if (whole == whole_.end()) return false;
        id = whole->second;
        const std::string_view type = file_.typeOf(id);
        if (type.starts_with("IFCWALL") || type.starts_with("IFCCURTAINWALL")) return true;
    }
    return false;
}

std::string IfcTree::nameAbove(StepId id, std::string_view type) const {
    const StepId found = above(id, type);
    return found == 0 ? "" : file_.read(found)[2].text();
}

StepId IfcTree::hostOf(StepId hole) const {
    const auto found = host_.find(hole);
    return found == host_.end() ? 0 : found->second;
}

StepId IfcTree::fillerOf(StepId hole) const {
    const auto found = filler_.find(hole);
    return found == filler_.end() ? 0 : found->second;
}

std::vector<StatedArea> IfcTree::areasOf(StepId space) const {
    std::vector<StatedArea> areas;
    if (const auto found = definitions_.find(space); found != definitions_.end())
        for (const StepId definition : found->second) addAreas(definition, areas);
    const auto rank = [](const StatedArea& area) {
        if (area.name == "NetFloorArea") return 0;
        if (area.name == "GrossFloorArea") return 1;
        return area.name.find("GSA") != std::string::npos ? 2 : 3;
    };
    std::stable_sort(areas.begin(), areas.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    return areas;
}

void IfcTree::addAreas(StepId definition, std::vector<StatedArea>& areas) const {
    const StepInstance set = file_.read(definition);
    const bool is_quantities = set.type == "IFCELEMENTQUANTITY";
    if (!is_quantities && set.type != "IFCPROPERTYSET") return;
    for (const StepValue& item : set[is_quantities ? 5 : 4].list()) {
        const StepInstance one = file_.read(item.reference());
        const StepValue value = one[is_quantities ? 3 : 2];
        const bool is_area =
            one.type == "IFCQUANTITYAREA" ||
            (one.type == "IFCPROPERTYSINGLEVALUE" && value.type() == "IFCAREAMEASURE");
        const std::string name = one[0].text();
        const double area = value.number().value_or(0);
        // Walls and ceilings have areas, too; only floor areas come first.
        if (is_area && area > 0 &&
            (name.find("Floor") != std::string::npos || name.find("BIM Area") != std::string::npos))
            areas.push_back({name, area});
    }
}

}  // namespace ispace::ifc
