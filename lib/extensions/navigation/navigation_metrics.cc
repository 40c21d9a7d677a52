// SPDX-License-Identifier: GPL-3.0-or-later
// One pass over the moments for each figure. Durations are those from a moment to the next one: the
// last moment has none, and an intrusion at it counts, but lasts 0 s. Jerk is a third difference
// over h^3 on steps of h, not a derivative of a smoothed way: noise of the record of 1 mm at h of
// 0.1 s is 8 m/s^3 at most, which is why steps are no shorter.
#include "extensions/navigation/navigation_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "geom/point.h"

namespace ispace::navigation {

namespace {

using Moments = std::span<const NavigationMoment>;
/// Seconds by which times of equal moments may differ.
constexpr double kSameTime = 1e-6;

/// Returns the moments up to the arrival, and whether there is one.
std::pair<Moments, bool> untilArrival(const NavigationRun& run, const NavigationGoal& goal) {
    const Moments all = run.moments;
    const auto at = std::find_if(all.begin(), all.end(), [&](const NavigationMoment& one) {
        return one.room == goal.room && distance(one.place, goal.place) <= goal.reach;
    });
    if (at == all.end()) return {all, false};
    return {all.first(static_cast<std::size_t>(at - all.begin()) + 1), true};
}

double wayBetween(const NavigationMoment& a, const NavigationMoment& b) {
    return a.room == b.room ? distance(a.place, b.place) : 0;
}

Intrusions intrusionsOf(Moments moments, double space) {
    Intrusions found;
    std::set<std::size_t> before, now;
    for (std::size_t i = 0; i < moments.size(); ++i) {
        now.clear();
        for (const PersonGap& one : moments[i].people)
            if (one.gap < space) now.insert(one.person);
        for (const std::size_t person : now) found.count += before.count(person) == 0 ? 1 : 0;
        if (!now.empty() && i + 1 < moments.size())
            found.seconds += moments[i + 1].time - moments[i].time;
        std::swap(before, now);
    }
    return found;
}

/// Counts halts, and adds up the time in which the robot stands.
void measureHalts(Moments moments, NavigationFigures& figures) {
    bool has_moved = false;
    double halt = 0;  // so far
    for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
        const double duration = moments[i + 1].time - moments[i].time;
        if (wayBetween(moments[i], moments[i + 1]) >= kStandingSpeed * duration) {
            has_moved = true;
            halt = 0;
            continue;
        }
        figures.still += duration;
        if (!has_moved) continue;
        const bool was_stop = halt >= kStopTime - kSameTime;
        halt += duration;
        figures.stops += !was_stop && halt >= kStopTime - kSameTime ? 1 : 0;
    }
}

void measureJerk(Moments moments, NavigationFigures& figures) {
    if (moments.size() < 2) return;
    const double interval = moments[1].time - moments[0].time;
    for (std::size_t i = 1; i + 1 < moments.size(); ++i)
        if (std::abs(moments[i + 1].time - moments[i].time - interval) > kSameTime) return;
    const auto stride =
        static_cast<std::size_t>(std::max(1.0, std::ceil(kJerkInterval / interval - kSameTime)));
    const double h = static_cast<double>(stride) * interval;
    double sum = 0, greatest = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i + 3 * stride < moments.size(); i += stride) {
        const NavigationMoment &a = moments[i], &b = moments[i + stride],
                               &c = moments[i + 2 * stride], &d = moments[i + 3 * stride];
        if (a.room != b.room || b.room != c.room || c.room != d.room) continue;
        const Vec2 third = (d.place - a.place) - 3 * (c.place - b.place);
        const double jerk = std::sqrt(dot(third, third)) / (h * h * h);
        sum += jerk;
        greatest = std::max(greatest, jerk);
        ++count;
    }
    if (count == 0) return;
    figures.jerk = sum / static_cast<double>(count);
    figures.greatest_jerk = greatest;
}

void countContacts(const NavigationRun& run, double end, NavigationFigures& figures) {
    std::map<std::string, double> last;
    for (const NavigationContact& one : run.contacts) {
        if (one.time > end + kSameTime) break;
        const auto [found, is_new] = last.emplace(one.pair, one.time);
        const bool counts = is_new || one.time - found->second > kSameContact;
        found->second = one.time;
        if (!counts) continue;
        switch (one.kind) {
            case NavigationContact::Kind::Person:
                ++figures.with_people;
                break;
            case NavigationContact::Kind::Robot:
                ++figures.with_robots;
                break;
            case NavigationContact::Kind::Thing:
                ++figures.with_things;
                break;
            case NavigationContact::Kind::BetweenPeople:
                ++figures.between_people;
                break;
        }
    }
}

}  // namespace

NavigationFigures navigationFigures(const NavigationRun& run, const NavigationGoal& goal) {
    const auto [moments, has_come] = untilArrival(run, goal);
    NavigationFigures figures;
    figures.success = has_come;
    figures.duration = moments.back().time - moments.front().time;
    if (has_come) figures.time = figures.duration;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < moments.size(); ++i) {
        if (i > 0) figures.path += wayBetween(moments[i - 1], moments[i]);
        for (const PersonGap& one : moments[i].people) nearest = std::min(nearest, one.gap);
    }
    if (std::isfinite(nearest)) figures.nearest = nearest;
    figures.way = goal.way;
    if (goal.way) {
        const double longer = std::max(*goal.way, figures.path);
        figures.spl = !has_come ? 0 : longer > 0 ? *goal.way / longer : 1;
        if (has_come && *goal.way > 0) figures.ratio = figures.path / *goal.way;
    }
    if (figures.duration > 0) figures.speed = figures.path / figures.duration;
    figures.intimate = intrusionsOf(moments, kIntimateSpace);
    figures.personal = intrusionsOf(moments, kPersonalSpace);
    measureHalts(moments, figures);
    measureJerk(moments, figures);
    countContacts(run, moments.back().time, figures);
    return figures;
}

}  // namespace ispace::navigation
