// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/fan_arc.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "cover/visible.h"

namespace ispace {

namespace {

/// Degrees beyond its sides in which a fan still sees.
constexpr double kSlack = 1e-9;

/// Numbers the doubles in (-180, 180], one after another counter-clockwise from 1 on; those beyond
/// kTurn are the same once more.
constexpr auto kHalfTurn = std::bit_cast<std::uint64_t>(180.0);
constexpr std::uint64_t kTurn = 2 * kHalfTurn;

std::uint64_t numberOf(Angle direction) {
    const double degrees = direction.degrees();
    const auto size = std::bit_cast<std::uint64_t>(std::abs(degrees));
    return degrees < 0 ? kHalfTurn - size : kHalfTurn + size;
}

Angle directionAt(std::uint64_t number) {
    if (number > kTurn) number -= kTurn;
    return Angle::degrees(number < kHalfTurn ? -std::bit_cast<double>(kHalfTurn - number)
                                             : std::bit_cast<double>(number - kHalfTurn));
}

/// In which directions a laser sees.
class Fan {
  public:
    Fan(const Laser& laser, Angle heading) : laser_(laser), heading_(heading) {}

    [[nodiscard]] bool sees(Angle direction) const {
        if (laser_.sees(direction - heading_)) return true;
        if (laser_.sweep != SweepAxis::Heading) return false;
        // The rule of sweeps is not in the laser: a cell is asked for.
        const auto distance = static_cast<float>(laser_.max_range / 2);
        const VisibleCells visible{{{0, distance, direction.degrees()}}};
        return !cellsInFan(Grid{Box2{{0, 0}, {1, 1}}, 1, 1}, visible, laser_, heading_).empty();
    }

    /// The first direction near to `about` in which it sees, or does not, as `seen` says, after
    /// others in which it does the contrary. None unless there is one such change.
    [[nodiscard]] std::optional<Angle> change(Angle about, bool seen) const {
        // Roundings mostly are within the first; the second is all that they may come to, which
        // counts where it reaches across 180 degrees.
        const bool may_be_torn = std::abs(wrapped(about).degrees()) > 180 - kSlack;
        for (const double around : {may_be_torn ? kSlack / 2 : 1e-12, kSlack / 2}) {
            const Angle by = Angle::degrees(around);
            const std::uint64_t low = numberOf(wrapped(about - by));
            std::uint64_t high = numberOf(wrapped(about + by));
            if (high < low) high += kTurn;
            if (is(low, seen) || !is(high, seen)) continue;
            // Up to 180 degrees, and from -180 on, differences round in order, but not across.
            if (low <= kTurn && kTurn < high && is(kTurn, seen) && !is(kTurn + 1, seen)) return {};
            return directionAt(firstIn(low, high, seen));
        }
        return {};
    }

  private:
    [[nodiscard]] bool is(std::uint64_t number, bool seen) const {
        return sees(directionAt(number)) == seen;
    }
    [[nodiscard]] std::uint64_t firstIn(std::uint64_t low, std::uint64_t high, bool seen) const {
        while (high - low > 1) {
            const std::uint64_t middle = low + (high - low) / 2;
            (is(middle, seen) ? high : low) = middle;
        }
        return high;
    }

    const Laser& laser_;
    Angle heading_;
};

}  // namespace

std::optional<FanArc> fanArc(const Laser& laser, Angle heading) {
    // Larger angles round by more than change() looks for.
    constexpr double kLargest = 1e6;
    if (laser.seesAround() ||
        std::abs(heading.degrees()) + std::abs(laser.first.degrees()) > kLargest)
        return {};
    const FanLimits limits = fanLimits(laser, heading);
    const Angle slack = Angle::degrees(kSlack);
    const Fan fan(laser, heading);
    const std::optional<Angle> first = fan.change(limits.first - slack, true);
    if (!first) return {};
    const std::optional<Angle> beyond = fan.change(limits.first + limits.span + slack, false);
    if (!beyond) return {};
    return FanArc{*first, *beyond};
}

}  // namespace ispace
