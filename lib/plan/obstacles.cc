// SPDX-License-Identifier: GPL-3.0-or-later
// The obstacle map at a height, as a plan.
#include <algorithm>
#include <map>

#include "base/number.h"
#include "plan/element_lines.h"
#include "plan/drawing.h"
#include "plan/slice_owners.h"

namespace ispace {

namespace {

using namespace plan_colors;

constexpr Color kSolid = Color::rgb(0x4A4F55);

}  // namespace

void addObstacles(PlanDrawing& plan, const Environment& environment, double height) {
    const std::string at_height = " at " + formatDouble(height) + " m";
    const Box2& box = plan.box;
    plan.items.push_back({PlanLayer::Floor, "", "not indoor"});
    plan.items.back().paths.push_back(
        {{{box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}}},
         true,
         kOutside,
         {}});
    DrawnPath floor{curvesOf(environment.indoor()), true, kPaper, {}};
    plan.items.push_back({PlanLayer::Floor, "", "free floor" + at_height});
    plan.items.back().paths.push_back(std::move(floor));

    const Slice slice = environment.slice(height);
    const SliceOwners owners = ownersOf(environment, slice);
    struct Parts {
        std::vector<Segment2> sheets;
        std::vector<Polygon> solids;
    };
    std::map<std::size_t, Parts> parts;  // by element, nobody's last
    for (std::size_t i = 0; i < slice.sheets.size(); ++i)
        parts[owners.sheets[i]].sheets.push_back(slice.sheets[i]);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        parts[owners.solids[i]].solids.push_back(slice.solids[i]);
    for (auto& [owner, of_one] : parts) {
        const bool known = owner < environment.elements().size();
        const std::string id = known ? environment.elements()[owner].id : "";
        DrawnItem item{PlanLayer::Walls, id, id + at_height};
        for (Polygon& solid : of_one.solids)
            item.paths.push_back({{std::move(solid)}, true, kSolid, Stroke{kSolid, 0.03}});
        if (!of_one.sheets.empty())
            item.paths.push_back({chained(of_one.sheets), false, {}, Stroke{kInk, 0.1}});
        plan.items.push_back(std::move(item));
    }
}

}  // namespace ispace
