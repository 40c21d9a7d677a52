// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/sighting.h"

#include <cstdint>
#include <limits>
#include <span>

namespace ispace {

namespace {

constexpr double kUnseen = std::numeric_limits<double>::infinity();

class Looker {
  public:
    Looker(const Observer& observer, const RayWorld& mesh, const MovingBodies& bodies)
        : observer_(observer), mesh_(mesh), bodies_(bodies), origin_(observer.view.frame.origin) {}

    /// Returns the numbers, ascending, of the bodies that may be in view.
    [[nodiscard]] std::vector<std::uint32_t> bodiesAround() const {
        constexpr double kMargin = 1e-6;  // above the rounding of ranges to float32
        return bodies_.bodiesNear(origin_.onFloor(),
                                  observer_.view.farthest() * (1 + kMargin) + kMargin);
    }

    /// Returns the nearest sighting of these bodies, of one mover.
    [[nodiscard]] Sighting nearest(std::span<const std::uint32_t> numbers) const {
        Sighting best{.range = kUnseen, .direction = {}};
        for (const std::uint32_t i : numbers) {
            const MovingBody& body = bodies_.bodies()[i];
            const Point2 foot = body.pose.position;
            const Vec3 way = Point3{foot.x, foot.y, body.middle()} - origin_;
            const double distance = length(way);
            if (distance == 0) continue;
            const Vec3 direction = (1 / distance) * way;
            const double range = bodies_.meet(i, origin_, direction);
            // From inside, the ray meets the surface behind the centre.
            if (range > distance || range >= best.range || !isInView(range, direction) ||
                !isFree(range, direction, body.owner))
                continue;
            best = {range, direction, &body};
        }
        return best;
    }

  private:
    [[nodiscard]] bool isInView(double range, Vec3 direction) const {
        return static_cast<float>(range) >= static_cast<float>(observer_.min_range) &&
               observer_.view.holds(origin_ + range * direction);
    }

    [[nodiscard]] bool isFree(double range, Vec3 direction, std::uint32_t owner) const {
        if (range == 0) return true;
        const Point3 at = origin_ + range * direction;
        const bool is_hidden = bodies_.anyAlong(origin_, at, [&](std::size_t i) {
            const std::uint32_t other = bodies_.bodies()[i].owner;
            return other != observer_.carrier && other != owner &&
                   bodies_.meet(i, origin_, direction) < range;
        });
        if (is_hidden) return false;
        std::uint8_t seen = 0;
        mesh_.query(origin_, std::span(&at, 1), std::span(&seen, 1));
        return seen != 0;
    }

    const Observer& observer_;
    const RayWorld& mesh_;
    const MovingBodies& bodies_;
    Point3 origin_;
};

}  // namespace

std::vector<Sighting> sightingsOf(const Observer& observer, const RayWorld& mesh,
                                  const MovingBodies& bodies,
                                  const std::function<bool(std::uint32_t owner)>& is_meant) {
    const Looker looker(observer, mesh, bodies);
    const std::vector<std::uint32_t> around = looker.bodiesAround();
    std::vector<Sighting> sightings;
    for (std::size_t begin = 0, end = 0; begin < around.size(); begin = end) {
        const std::size_t number = bodies.moverOf(around[begin]);
        while (end < around.size() && bodies.moverOf(around[end]) == number) ++end;
        const std::uint32_t owner = bodies.bodies()[around[begin]].owner;
        if (owner == observer.carrier || !is_meant(owner)) continue;
        Sighting seen = looker.nearest(std::span(around).subspan(begin, end - begin));
        if (seen.range == kUnseen) continue;
        seen.number = number;
        sightings.push_back(seen);
    }
    return sightings;
}

}  // namespace ispace
