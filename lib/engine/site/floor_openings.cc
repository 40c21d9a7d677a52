// SPDX-License-Identifier: GPL-3.0-or-later
// Openings in floors, and the storeys that one reaches through them. Stairs that turn have no
// opening: their flights hide the view.
#include <algorithm>

#include "env/walls.h"
#include "geom/polygon.h"
#include "scene/placement_schemas.h"
#include "site/coupling.h"

namespace ispace {

namespace {

/// Returns the opening of a flight that leads straight ahead; without outline for others.
FloorOpening openingOf(const Record& stairs) {
    const Point2 foot = pointOf(stairs.tuple("at"));
    const Pose2 frame{foot, stairs.angle("heading")};
    const double width = stairs.tuple("size")[0], run = stairs.tuple("size")[1];
    constexpr double kStraight = 1e-3;
    FloorOpening opening;
    if (stairs.has("top") &&
        distance(pointOf(stairs.tuple("top")), frame * Point2{run, 0}) > kStraight)
        return opening;
    const Point2 right = frame * Point2{0, -width / 2}, left = frame * Point2{0, width / 2};
    const Point2 far_right = frame * Point2{run, -width / 2};
    const Point2 far_left = frame * Point2{run, width / 2};
    opening.outline = {right, far_right, far_left, left};
    opening.flight = {{right, left}, {far_right, far_left}};
    return opening;
}

FloorOpening openingOfShaft(const Record& shaft) {
    FloorOpening opening;
    for (const Tuple& corner : shaft.list("path")) opening.outline.push_back(pointOf(corner));
    if (signedArea(opening.outline) < 0)
        std::reverse(opening.outline.begin(), opening.outline.end());
    return opening;
}

}  // namespace

std::vector<FloorOpening> floorOpenings(const SiteScene& building) {
    std::vector<FloorOpening> openings;
    for (const StoreyPassage& passage : building.document.passages) {
        const bool is_shaft = passage.record.keyword() == "shaft";
        if (!is_shaft && passage.record.keyword() != "stairs") continue;
        FloorOpening opening =
            is_shaft ? openingOfShaft(passage.record) : openingOf(passage.record);
        if (opening.outline.size() < 3 || signedArea(opening.outline) == 0) continue;
        opening.passage = passage.id;
        for (std::size_t k = 0; k + 1 < passage.storeys.size(); ++k) {
            opening.below = passage.storeys[k];
            opening.above = passage.storeys[k + 1];
            const auto& storeys = building.document.storeys;
            if (storeys[opening.below].floor < storeys[opening.above].floor)
                openings.push_back(opening);
        }
    }
    return openings;
}

bool hasFloor(const Scene& scene) { return scene.environment.indoor().area() > kNoFloor; }

std::vector<std::vector<bool>> storeysAbove(std::size_t storeys,
                                            std::span<const FloorOpening> openings) {
    std::vector<std::vector<bool>> reached(storeys, std::vector<bool>(storeys));
    std::vector<std::vector<std::size_t>> above(storeys);
    for (const FloorOpening& opening : openings) above[opening.below].push_back(opening.above);
    // The lowest storey is the first.
    for (std::size_t i = storeys; i-- > 0;)
        for (const std::size_t next : above[i]) {
            reached[i][next] = true;
            for (std::size_t k = next + 1; k < storeys; ++k)
                if (reached[next][k]) reached[i][k] = true;
        }
    return reached;
}

}  // namespace ispace
