// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/motes/mote_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "extensions/luxes/illuminance.h"
#include "sense/walls_between.h"

namespace ispace::motes {

namespace {

constexpr double kNearField = 0.01;  // metres: nearer, signals grow no stronger

/// Where the motes send from that movers carry.
class CarriedMotes {
  public:
    explicit CarriedMotes(const Moment& now) {
        for (const MovingBody& body : now.bodies.bodies()) {
            // The trunk is a person's first box.
            if (body.owner >= kFirstPerson && body.radius > 0) continue;
            poses_.try_emplace(body.owner, body.pose);
        }
    }
    [[nodiscard]] std::optional<Point3> placeOf(const MoteRadio& mote) const {
        const auto mover = static_cast<std::uint32_t>(mote.carrier);
        const auto found = poses_.find(mote.is_on_person ? kFirstPerson + mover : mover);
        if (found == poses_.end()) return std::nullopt;
        const Point2 foot = found->second * mote.at.onFloor();
        return Point3{foot.x, foot.y, mote.at.z};
    }

  private:
    std::unordered_map<std::uint32_t, Pose2> poses_;  // of bodies, by their owners
};

/// The table of neighbours of a mote: the strongest signals, of equal ones the first in the scene.
class NeighbourTable {
  public:
    NeighbourTable(const Mote& mote, const Moment& now) : mote_(mote), now_(now) {}

    /// Returns how much stronger a signal over this distance is, without walls, than the weakest
    /// that is heard.
    [[nodiscard]] double freeMargin(double distance) const {
        return 20 * std::log10(mote_.radio / std::max(kNearField, distance));
    }
    /// Returns whether a signal with this margin may enter the table.
    [[nodiscard]] bool mayTake(double margin) const {
        return margin >= 0 &&
               (heard_.size() < Mote::kMostNeighbours || margin >= heard_.front().margin);
    }
    void offer(std::uint32_t number, Point3 from) {
        if ((mote_.motes.begin() + number)->id == now_.sensor.idInRoom()) return;
        const Point3 here = now_.pose.position;
        const double free = freeMargin(length(from - here));
        if (!mayTake(free)) return;
        const Heard one{free - mote_.loss * wallsBetween(here, from, now_.mesh()), number};
        if (!mayTake(one.margin)) return;
        heard_.push_back(one);
        std::push_heap(heard_.begin(), heard_.end(), isStronger);
        if (heard_.size() <= Mote::kMostNeighbours) return;
        std::pop_heap(heard_.begin(), heard_.end(), isStronger);
        heard_.pop_back();
    }
    /// In the order of the scene.
    [[nodiscard]] std::vector<Neighbour> neighbours() {
        std::sort(heard_.begin(), heard_.end(),
                  [](const Heard& a, const Heard& b) { return a.number < b.number; });
        std::vector<Neighbour> list;
        list.reserve(heard_.size());
        for (const Heard& one : heard_)
            list.push_back(
                {now_.sensor.idBeside((mote_.motes.begin() + one.number)->id), one.margin});
        return list;
    }

  private:
    struct Heard {
        double margin;
        std::uint32_t number;
    };
    static bool isStronger(const Heard& a, const Heard& b) {
        return a.margin != b.margin ? a.margin > b.margin : a.number < b.number;
    }

    const Mote& mote_;
    const Moment& now_;
    std::vector<Heard> heard_;  // a heap, the weakest at its front
};

std::vector<Neighbour> neighboursOf(const Mote& mote, const Moment& now) {
    if (mote.motes.size() == 0) return {};
    NeighbourTable table(mote, now);
    const MoteGrid& grid = *mote.grid.begin();
    if (!grid.carried().empty()) {
        const CarriedMotes carried(now);
        for (const std::uint32_t i : grid.carried())
            if (const auto from = carried.placeOf(*(mote.motes.begin() + i))) table.offer(i, *from);
    }
    std::vector<std::pair<double, std::uint32_t>> near;  // the nearest first: walls cost rays
    grid.forEachRing(
        now.pose.position.onFloor(), [&](std::span<const std::uint32_t> ring, double next) {
            near.clear();
            for (const std::uint32_t i : ring)
                near.emplace_back(length((mote.motes.begin() + i)->at - now.pose.position), i);
            std::sort(near.begin(), near.end());
            for (const auto& [distance, i] : near) table.offer(i, (mote.motes.begin() + i)->at);
            constexpr double kRounding = 1 - 1e-9;
            return table.mayTake(table.freeMargin(kRounding * next));
        });
    return table.neighbours();
}

}  // namespace

MoteReport readingOf(const Mote& mote, const Moment& now) {
    return {readingOf(mote.meter, now).lux, neighboursOf(mote, now)};
}

}  // namespace ispace::motes
