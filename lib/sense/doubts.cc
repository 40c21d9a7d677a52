// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/doubts.h"

#include <map>

#include "base/number.h"
#include "geom/box_tree.h"
#include "geom/predicates.h"
#include "trace/ray_world.h"

namespace ispace {

struct SolidJudge::Data {
    /// Solids of one height.
    struct Level {
        std::vector<Polygon> solids;
        BoxTree boxes;
    };

    const Environment& environment;
    std::map<double, Level> levels = {};

    const Level* at(double height) {
        constexpr std::size_t kMostLevels = 64;
        const auto known = levels.find(height);
        if (known != levels.end()) return &known->second;
        if (levels.size() == kMostLevels) return nullptr;
        Level& level = levels[height];
        level.solids = environment.slice(height).solids;
        std::vector<Box2> boxes;
        boxes.reserve(level.solids.size());
        for (const Polygon& solid : level.solids) boxes.push_back(bounds(solid));
        level.boxes = BoxTree(boxes);
        return &level;
    }
};

SolidJudge::SolidJudge(const Environment& environment)
    : data_(std::make_unique<Data>(Data{environment})) {}
SolidJudge::~SolidJudge() = default;

bool SolidJudge::isInside(Point3 place) {
    const Data::Level* const level = data_->at(place.z);
    if (level == nullptr) return false;
    const Point2 p = place.onFloor();
    bool inside = false;
    level->boxes.search({p, p}, [&](std::size_t i) {
        const Polygon& solid = level->solids[i];
        if (inside || locate(solid, p) != Side::Inside) return;
        inside = true;
        forEachEdge(solid, [&](const Segment2& edge) {
            inside = inside && distance(nearestPoint(edge, p), p) > kContact;
        });
    });
    return inside;
}

std::vector<std::string> doubtsAbout(const Scene& scene, const Sensors& sensors,
                                     const std::vector<std::string>& globs, bool with_receivers) {
    std::vector<std::string> doubts;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (!isReadable(record.keyword()) || record.has("at") || record.has("on") ||
            !isSelected(scene.ids[i], globs))
            continue;
        doubts.push_back(scene.ids[i] + " has no place and is left out: give it `at` or `on`" +
                         (record.keyword() == "laser" ? ", or let arrange place it" : ""));
    }
    SolidJudge judge(scene.environment);
    const auto check = [&](const std::string& id, const Point3& place) {
        const bool inside = judge.isInside(place);
        if (!inside && place.z >= 0 &&
            scene.environment.indoor().locate(place.onFloor()) != Side::Outside)
            return;
        std::string phrase = id;
        phrase.append(inside ? " stands inside something solid at "
                             : " stands outside the room at ");
        for (const double part : {place.x, place.y, place.z})
            phrase.append(formatDouble(part)).append(",");
        phrase.pop_back();
        doubts.push_back(std::move(phrase));
    };
    for (const Sensors::Entry& entry : sensors.order)
        check(sensors.id(entry), sensors.pose(entry).position);
    if (with_receivers || !sensors.tags.empty())
        for (const PlacedReceiver& receiver : sensors.receivers)
            check(receiver.id, receiver.pose.position);
    return doubts;
}

}  // namespace ispace
