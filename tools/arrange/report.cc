// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/report.h"

#include <algorithm>

#include "base/message.h"
#include "base/number.h"
#include "cover/text_table.h"
#include "place/curve.h"

namespace ispace {

namespace {

std::string counted(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

/// Share of the bound that is open; 0 for a layout that is proven best.
double gapOf(const Arrangement& arrangement) {
    const double bound = arrangement.candidate_bound;
    return bound > 0 ? std::max(0.0, (bound - arrangement.candidate_value) / bound) : 0;
}

/// The step that a signal or the time limit ended after the candidates were chosen.
std::string unfinishedText(const ArrangeOptions& how) {
    return how.target ? "the search for fewer sensors" : how.refine ? "refining" : "the curve";
}

std::string overText(const ArrangeOptions& how, const Arrangement& arrangement) {
    return "over " + counted(arrangement.candidates, "candidate", "candidates") + " (" +
           std::string(nameOf(how.strategy)) + ", " + formatBytes(arrangement.bytes) + ") on " +
           cellsText(arrangement.grid);
}

}  // namespace

std::string reportText(const ArrangeOptions& how, const Arrangement& arrangement) {
    std::string text = "arrange: " + counted(arrangement.sensors.size(), "sensor", "sensors") +
                       ", coverage " + percentText(arrangement.coverage);
    // The bound is about what was maximised, before it was refined.
    if (arrangement.value)
        text += "; value " + percentText(arrangement.candidate_value);
    else if (how.refine)
        text += "; before it was refined " + percentText(arrangement.candidate_value);
    const double gap = gapOf(arrangement);
    text += ", bound " + percentText(arrangement.candidate_bound) + " (" +
            (gap > 0 ? "gap " + percentText(gap) : "proven best") + ") " +
            overText(how, arrangement);
    if (!arrangement.is_complete && gap > 0) text += ", cut short";
    text += '\n';
    if (!arrangement.is_complete && gap <= 0)
        text += "arrange: " + unfinishedText(how) + " was cut short\n";
    if (how.refine && arrangement.refined_after > arrangement.refined_before) {
        text += "arrange: refined from " + formatFixed(arrangement.refined_before, 3) + " to " +
                formatFixed(arrangement.refined_after, 3) +
                " m2 by exact area, off the candidates; " +
                (arrangement.bound < 1 ? "from any places at all at most " +
                                             percentText(arrangement.bound) + " can be covered"
                                       : "for any places at all no bound below 100% is known") +
                '\n';
    } else if (how.refine) {
        text += "arrange: refining found nothing better than " +
                formatFixed(arrangement.refined_before, 3) + " m2 by exact area\n";
    }
    if (arrangement.least) {
        text += "arrange: target " + percentText(*how.target) + " reached " +
                (arrangement.has_costs
                     ? "at a cost of " + formatDouble(arrangement.cost) +
                           "; nothing cheaper than " + formatDouble(*arrangement.least)
                     : "by " + counted(arrangement.sensors.size(), "sensor", "sensors") +
                           "; none fewer than " + formatDouble(*arrangement.least)) +
                " of these candidates can\n";
    }
    if (how.budget)
        text += "arrange: cost " + formatDouble(arrangement.cost) + " of a budget of " +
                formatDouble(*how.budget) + '\n';
    if (!arrangement.curve.empty()) text += curveText(arrangement.curve);
    return text;
}

std::string shortfallText(const ArrangeOptions& how, const Arrangement& arrangement) {
    std::string text = "the target of " + formatPercent(how.target.value_or(1)) +
                       " is not reached: " +
                       counted(arrangement.sensors.size(), "sensor covers ", "sensors cover ") +
                       percentText(arrangement.candidate_value);
    if (arrangement.candidate_bound < how.target.value_or(1))
        text += ", and no layout of these candidates covers more than " +
                percentText(arrangement.candidate_bound);
    if (!arrangement.is_complete) return text + "; the search was cut short";
    if (arrangement.is_exhausted)
        return text +
               "; all candidates together see no more: try denser ones (--candidates), other "
               "places (--mount, --z) or sensors";
    return text + "; allow more sensors (:COUNT), or denser candidates";
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
            if (!(p == sensors[k].pose.position)) continue;
            return printable(sensors[i].sensor) + " and " + printable(sensors[k].sensor) +
                   " are at one place (" + formatDouble(p.x) + ", " + formatDouble(p.y) + ", " +
                   formatDouble(p.z) + "): mount them side by side";
        }
    return "";
}

}  // namespace ispace
