// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/crowd.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "env/level.h"
#include "geom/predicates.h"
#include "record/text.h"
#include "scene/bodies.h"
#include "scene/placement_schemas.h"

namespace ispace::robustness {

namespace {

constexpr std::size_t kMaxDraws = 1000;

}  // namespace

Scene withCrowd(const Scene& scene, const Crowd& crowd) {
    if (crowd.empty()) return scene;
    Scene filled = scene;
    std::set<std::string> taken(scene.ids.begin(), scene.ids.end());
    for (std::size_t i = 0; i < crowd.size(); ++i) {
        std::string id = "crowd" + std::to_string(i + 1);
        while (!taken.insert(id).second) id += '-';
        const double width = 2 * humanRadius(crowd[i].height);
        Record body(*sceneSchemas().find("cylinder"));
        body.set("id", Value(id));
        body.set("at", Value(Tuple{crowd[i].place.x, crowd[i].place.y}));
        body.set("size", Value(Tuple{width, width, crowd[i].height}));
        filled.records.push_back(std::move(body));
        filled.ids.push_back(std::move(id));
    }
    filled.environment = Environment(filled.records, filled.ids, scene.environment);
    filled.digest_of_other = scene.digest();
    return filled;
}

CrowdFloor::CrowdFloor(const Scene& scene)
    : scene_(scene), band_(scene.environment.band(0, kUsualHeight)), lines_(band_.lines()) {}

bool CrowdFloor::isFree(Point2 place) const {
    const double radius = humanRadius(kUsualHeight);
    if (scene_.environment.indoorIndex().locate(place) != Side::Inside) return false;
    for (const Sensor& sensor : scene_.sensors)
        if (sensor.pose.position.z < kUsualHeight && !sensor.mount && !sensor.person &&
            distance(sensor.pose.position.onFloor(), place) <= radius)
            return false;
    const Box2 around = Box2{place, place}.expanded(radius);
    const auto touches = [&](const Segment2& line) {
        return around.meets(bounds(line)) && distance(place, line) <= radius;
    };
    return std::none_of(lines_.begin(), lines_.end(), touches) && !band_.blocked(place);
}

Crowd CrowdFloor::draw(std::size_t count, RandomKey key) const {
    const Box2& limits = scene_.environment.limits();
    key.purpose = Purpose::Crowd;
    Crowd crowd;
    for (std::size_t i = 0; i < count; ++i) {
        key.sensor = i;
        std::vector<float> random(2 * kMaxDraws);
        ispace::draw(key, 0, {.uniform = random});
        const std::size_t before = crowd.size();
        for (std::size_t k = 0; k < random.size() && crowd.size() == before; k += 2) {
            const Point2 place{limits.low.x + limits.width() * static_cast<double>(random[k]),
                               limits.low.y + limits.depth() * static_cast<double>(random[k + 1])};
            const auto is_near = [&](const Bystander& other) {
                return distance(other.place, place) <=
                       humanRadius(kUsualHeight) + humanRadius(other.height);
            };
            if (isFree(place) && std::none_of(crowd.begin(), crowd.end(), is_near))
                crowd.push_back({place});
        }
        if (crowd.size() == before)
            throw UnmetError("no free floor for a crowd of " + std::to_string(count) + ": " +
                             std::to_string(before) + " fit");
    }
    return crowd;
}

}  // namespace ispace::robustness
