// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ifc/ifc_tree.h"

#include <algorithm>
#include <cmath>

namespace ispace {

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
    relate("IFCRELAGGREGATES", 4, 5, add_parent);
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
        // Walls and ceilings have areas, too.
        if (is_area && area > 0 &&
            (name.find("Floor") != std::string::npos || name.find("BIM Area") != std::string::npos))
            areas.push_back({name, area});
    }
}

}  // namespace ispace
