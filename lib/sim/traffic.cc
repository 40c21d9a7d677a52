// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/traffic.h"

#include <algorithm>
#include <numeric>

namespace ispace {

std::vector<std::size_t> settlingOrder(std::span<const PlacedRobot> robots) {
    std::vector<std::size_t> order(robots.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return robots[i].id < robots[j].id; });
    return order;
}

Traffic::Traffic(std::span<const PlacedRobot> robots, std::span<const Person> people,
                 std::span<const std::size_t> order, double duration)
    : rank_(robots.size() + people.size()), places_(rank_.size()) {
    // Robots get their own ranks below; people are settled after all of them.
    std::iota(rank_.begin(), rank_.end(), std::size_t{0});
    for (std::size_t k = 0; k < order.size(); ++k) rank_[order[k]] = k;
    for (const PlacedRobot& robot : robots)
        reach_ = std::max(reach_, robot.model.radius + robot.model.max_speed * duration);
    for (const Person& person : people) reach_ = std::max(reach_, person.radius);
}

void Traffic::rebuild(std::span<const Move> moves) {
    for (std::size_t i = 0; i < moves.size(); ++i) places_[i] = moves[i].start();
    grid_.rebuild(places_, reach_);
}

std::optional<std::size_t> Traffic::hit(std::span<const Move> moves, std::size_t robot) const {
    const Move& move = moves[robot];
    Box2 box;
    box.add(move.start());
    box.add(move.end());
    const Vec2 margin{move.radius + move.to.bulge, move.radius + move.to.bulge};
    box = {box.low - margin, box.high + margin};
    const std::size_t rank = rank_[robot];
    std::optional<std::size_t> first;
    grid_.forEachNear(box, [&](std::size_t other) {
        if (other == robot || (first && rank_[*first] < rank_[other])) return;
        if (collides(move, moves[other], rank_[other] < rank)) first = other;
    });
    return first;
}

}  // namespace ispace
