// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/sighting.h"

#include <algorithm>
#include <limits>
#include <span>

namespace ispace {

namespace {

constexpr double kUnseen = std::numeric_limits<double>::infinity();

class Looker {
  public:
    Looker(const Observer& observer, const RayWorld& mesh, std::span<const MovingBody> bodies)
        : observer_(observer), mesh_(mesh), bodies_(bodies), origin_(observer.view.frame.origin) {}

    /// Returns the nearest sighting of the bodies from `begin` to before `end`, of one mover.
    [[nodiscard]] Sighting nearest(std::size_t begin, std::size_t end) const {
        Sighting best{.range = kUnseen, .direction = {}};
        for (std::size_t i = begin; i < end; ++i) {
            const MovingBody& body = bodies_[i];
            const Point2 foot = body.pose.position;
            const Vec3 way = Point3{foot.x, foot.y, body.middle()} - origin_;
            const double distance = length(way);
            if (distance == 0) continue;
            const Vec3 direction = (1 / distance) * way;
            const double range = body.meet(origin_, direction);
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
        const bool is_hidden =
            std::any_of(bodies_.begin(), bodies_.end(), [&](const MovingBody& body) {
                return body.owner != observer_.carrier && body.owner != owner &&
                       body.meet(origin_, direction) < range;
            });
        if (is_hidden) return false;
        const Point3 at = origin_ + range * direction;
        std::uint8_t seen = 0;
        mesh_.query(origin_, std::span(&at, 1), std::span(&seen, 1));
        return seen != 0;
    }

    const Observer& observer_;
    const RayWorld& mesh_;
    std::span<const MovingBody> bodies_;
    Point3 origin_;
};

}  // namespace

std::vector<Sighting> sightingsOf(const Observer& observer, const RayWorld& mesh,
                                  const MovingBodies& bodies,
                                  const std::function<bool(std::uint32_t owner)>& is_meant) {
    const std::span<const MovingBody> all = bodies.bodies();
    const Looker looker(observer, mesh, all);
    std::vector<Sighting> sightings;
    std::size_t number = 0;
    // The bodies of a mover follow one another.
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end, ++number) {
        const std::uint32_t owner = all[begin].owner;
        while (end < all.size() && all[end].owner == owner) ++end;
        if (owner == observer.carrier || !is_meant(owner)) continue;
        Sighting seen = looker.nearest(begin, end);
        if (seen.range == kUnseen) continue;
        seen.number = number;
        sightings.push_back(seen);
    }
    return sightings;
}

}  // namespace ispace
