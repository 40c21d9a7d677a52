// SPDX-License-Identifier: GPL-3.0-or-later
// The lines that arrange prints about a layout.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include "arrange/arrange_run.h"
#include "arrange/search/set_cover.h"
#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"
#include "report/curve_chart.h"

namespace ispace {

namespace {

constexpr double kProven = 1e-9;  // sums of areas differ by less

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return std::to_string(count).append(1, ' ').append(count == 1 ? one : many);
}

/// Returns true if all cells are covered, but not all of the exact area between their centres.
bool isShort(const Arrangement& arrangement) {
    return !arrangement.is_reached && arrangement.exact_share && arrangement.least;
}

/// Returns the step that a signal or the time limit ended after the candidates were chosen.
std::string unfinishedText(const ArrangeOptions& how) {
    return how.target        ? "the search for fewer sensors"
           : how.refine      ? "refining"
           : how.wants_curve ? "the curve"
                             : "the list of candidates";
}

std::string overText(const ArrangeOptions& how, const Arrangement& arrangement) {
    return "over " + counted(arrangement.candidates, "candidate", "candidates") + " (" +
           std::string(nameOf(how.strategy)) + ", " + formatBytes(arrangement.bytes) + ") on " +
           (how.demand ? counted(arrangement.cells, how.demand->one(), how.demand->many())
            : arrangement.rooms.empty() ? cellsText(arrangement.grid)
                                        : counted(arrangement.cells, "cell", "cells"));
}

/// Compares value and coverage if they differ by their cells alone; "" if the two agree.
std::string cellsGapText(const Arrangement& arrangement) {
    constexpr double kTold = 0.025, kHundred = 100;  // told as a share of the coverage
    if (!arrangement.is_value_by_cells) return "";
    const double gap = std::abs(*arrangement.value - arrangement.coverage);
    if (gap <= kTold * arrangement.coverage) return "";
    return "arrange: the cells of the search and those of coverage(1) are " +
           formatFixed(kHundred * gap, 2) + " points apart: these sensors cover " +
           percentText(*arrangement.value) + " and " + percentText(arrangement.coverage) +
           " (--cell M sets the size of cells)\n";
}

/// Returns a line for each of several rooms.
std::string roomsText(const Arrangement& arrangement) {
    std::string text;
    for (const Arrangement::InRoom& room : arrangement.rooms)
        text += "arrange: storey " + printable(room.id) + ": " +
                (room.has_floor ? counted(room.sensors, "sensor", "sensors") + ", coverage " +
                                      percentText(room.coverage)
                                : std::string("left out, all of its floor is open")) +
                '\n';
    return text;
}

}  // namespace

std::string reportText(const ArrangeWork& work, const Arrangement& arrangement) {
    const ArrangeOptions& how = work.how;
    std::string proven =
        arrangement.proof ? "arrange: " + arrangement.proof->finding(how, arrangement) + '\n' : "";
    if (arrangement.proof && arrangement.proof->replacesSearch()) return proven;
    std::ptrdiff_t standing = 0;
    for (const auto& room : work.input.rooms())
        standing +=
            std::count_if(room->sensors.begin(), room->sensors.end(), [](const Sensor& one) {
                return !one.mount && !one.person && kindOf(one.model).is_arranged;
            });
    std::string text = roomsText(arrangement);
    text += "arrange: " + counted(arrangement.sensors.size(), "sensor", "sensors") + ", coverage " +
            percentText(arrangement.coverage);
    // The bound holds for the objective before refinement.
    if (arrangement.value)
        text += "; value " + percentText(arrangement.candidate_value);
    else if (how.refine)
        text += "; before it was refined " + percentText(arrangement.candidate_value);
    const double gap = gapOf(arrangement);
    text += ", bound " + percentText(arrangement.candidate_bound) + " (" +
            (gap > 0                ? "gap " + percentText(gap)
             : isShort(arrangement) ? "all cells, not all of the area"
                                    : "proven best") +
            ") " + overText(how, arrangement);
    if (!arrangement.is_complete && gap > 0) text += ", cut short";
    text += '\n' + cellsGapText(arrangement);
    if (!arrangement.is_complete && gap <= 0 && !arrangement.proof)
        text += "arrange: " + unfinishedText(how) + " was cut short\n";
    if (how.refine && !arrangement.proof &&
        arrangement.refined_after > arrangement.refined_before) {
        text += "arrange: refined from " + formatFixed(arrangement.refined_before, 3) + " to " +
                formatFixed(arrangement.refined_after, 3) +
                " m2 by exact area, off the candidates; " +
                (arrangement.bound < 1 ? "from any places at all at most " +
                                             percentText(arrangement.bound) + " can be covered"
                                       : "for any places at all no bound below 100% is known") +
                '\n';
    } else if (how.refine && !arrangement.proof) {
        text += "arrange: refining found nothing better than " +
                formatFixed(arrangement.refined_before, 3) + " m2 by exact area\n";
    }
    if (arrangement.least) {
        text += "arrange: " +
                (isShort(arrangement) ? std::string("all cells covered ")
                                      : "target " + percentText(*how.target) + " reached ") +
                (arrangement.has_costs
                     ? "at a cost of " + formatDouble(arrangement.cost) +
                           "; nothing cheaper than " + formatDouble(*arrangement.least)
                     : "by " + counted(arrangement.sensors.size(), "sensor", "sensors") +
                           (standing > 0 ? " more" : "") + "; none fewer than " +
                           formatDouble(*arrangement.least)) +
                " of these candidates can\n";
    }
    if (arrangement.cases) text += "arrange: " + how.cases->finding(*arrangement.cases) + '\n';
    if (how.objective && arrangement.whole)
        text += "arrange: " + how.objective->finding(arrangement) + '\n';
    if (how.demand)
        if (const std::string finding =
                how.demand->finding(work.served(arrangement), arrangement.candidate_bound);
            !finding.empty())
            text += "arrange: " + finding + '\n';
    if (how.budget)
        text += "arrange: cost " + formatDouble(arrangement.cost) + " of a budget of " +
                formatDouble(*how.budget) + '\n';
    text += proven;
    if (!arrangement.curve.empty()) text += curveText(arrangement.curve);
    return text;
}

double gapOf(const Arrangement& arrangement) {
    const double bound = arrangement.candidate_bound;
    if (arrangement.rounding > 0 &&
        bound - arrangement.candidate_value <= arrangement.rounding + kProven)
        return 0;
    return bound > 0 ? std::max(0.0, (bound - arrangement.candidate_value) / bound) : 0;
}

std::string numberedFile(const std::string& output, std::size_t number) {
    const std::filesystem::path path(output);
    const std::string name =
        path.stem().string() + '-' + std::to_string(number) + path.extension().string();
    return (path.parent_path() / name).string();
}

std::string alternativesText(const std::string& output, const Arrangement& arrangement) {
    std::string text;
    for (std::size_t i = 0; i < arrangement.alternatives.size(); ++i) {
        const Arrangement& other = arrangement.alternatives[i];
        text += "arrange: " + printable(numberedFile(output, i + 2)) + ": value " +
                percentText(other.candidate_value) + ", gap " + percentText(gapOf(other)) +
                ", coverage " + percentText(other.coverage) + '\n';
    }
    return text;
}

std::string shortfallText(const ArrangeOptions& how, const Arrangement& arrangement) {
    if (arrangement.proof && arrangement.proof->replacesSearch())
        return arrangement.proof->shortfall(arrangement);
    if (isShort(arrangement))
        return "the target of 100% is not reached: " +
               counted(arrangement.sensors.size(), "sensor covers", "sensors cover") +
               " all cells, but " + formatPercent(roundSignificant(*arrangement.exact_share)) +
               " of the exact area; --target 99.9% asks for less, --candidates for denser ones";
    std::string text = "the target of " + formatPercent(how.target.value_or(1)) +
                       " is not reached: " +
                       counted(arrangement.sensors.size(), "sensor covers ", "sensors cover ") +
                       percentText(arrangement.candidate_value);
    if (arrangement.candidate_bound < how.target.value_or(1))
        text += ", and no layout of these candidates covers more than " +
                percentText(arrangement.candidate_bound);
    if (!arrangement.is_complete) return text + "; the search was cut short";
    // Sensors of higher planes see floor under things, and so may others by cells.
    const double free_share = arrangement.free_share.value_or(1);
    if (arrangement.is_exhausted && free_share < *how.target &&
        arrangement.coverage <= free_share + 1.0 / 50)
        return text + "; only " + percentText(free_share) +
               " of the indoor area is free floor, the rest is under walls and things";
    if (arrangement.is_exhausted)
        return text +
               "; all candidates together see no more: try denser ones (--candidates), other "
               "places (--mount, --z) or sensors";
    return text + "; allow more sensors (:COUNT), or denser candidates";
}

std::string inexactText(const ArrangeOptions& how, const Arrangement& arrangement) {
    if (!arrangement.is_reached || !arrangement.exact_share ||
        *arrangement.exact_share >= *how.target - kMissedShare)
        return "";
    const double share = *arrangement.exact_share;
    const std::string rounded = percentText(share);
    return "the target is reached by cells, but by exact area these sensors cover " +
           (rounded == percentText(*how.target) ? formatPercent(roundSignificant(share))
                                                : rounded) +
           " (as coverage(1) reports): try a higher --target, or smaller cells (--cell M)";
}

std::string idleText(const Arrangement& arrangement) {
    constexpr std::size_t kMaxNamed = 10;
    const std::vector<std::string>& idle = arrangement.idle;
    if (idle.empty()) return "";
    std::string text;
    for (std::size_t i = 0; i < std::min(idle.size(), kMaxNamed); ++i)
        text.append(i == 0 ? "" : ", ").append(printable(idle[i]));
    if (idle.size() > kMaxNamed)
        text += " and " + std::to_string(idle.size() - kMaxNamed) + " more";
    return text + (idle.size() == 1 ? " adds" : " add") + " nothing to what the others cover";
}

std::string doubledText(const Arrangement& arrangement) {
    const std::vector<Placement>& sensors = arrangement.sensors;
    for (std::size_t i = 0; i < sensors.size(); ++i)
        for (std::size_t k = i + 1; k < sensors.size(); ++k) {
            const Point3 p = sensors[i].pose.position;
            if (!(p == sensors[k].pose.position) || sensors[i].room != sensors[k].room) continue;
            const std::string room =
                arrangement.rooms.empty() ? "" : arrangement.rooms[sensors[i].room].id + '/';
            return printable(room + sensors[i].sensor) + " and " +
                   printable(room + sensors[k].sensor) + " are at one place (" + formatDouble(p.x) +
                   ", " + formatDouble(p.y) + ", " + formatDouble(p.z) +
                   "): mount them side by side";
        }
    return "";
}

}  // namespace ispace
