// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the units of a drawing by three measures: doors (weight 2), walls of two lines and a
// usual extent (1 each). The weights say that a leaf of 0.6 m to 1.2 m with its swing hardly
// appears by chance in a wrong unit, whereas parallel lines do. A unit decides by itself only with
// a lead of 0.6; otherwise the user is asked, with the ranking.
#include "io/plan/drawing_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "io/plan/drawing_source.h"
#include "io/plan/parallel_lines.h"
#include "io/plan/plan_lines.h"

namespace ispace {

namespace {

/// Metres.
constexpr double kNarrowDoor = 0.6, kWideDoor = 1.2;
constexpr double kSmallPlan = 2, kLargePlan = 500;         // impossible beyond
constexpr double kUsualPlan = 4, kLargestUsualPlan = 100;  // usual within

/// A drawing with a smaller share of such lines has no walls of two lines.
constexpr double kFewWalls = 0.15, kMostWalls = 0.3;

constexpr double kLead = 0.6;  // of a score that decides
constexpr std::size_t kSureDoors = 2;
constexpr std::size_t kMaxLines = 20'000;

constexpr std::array<const char*, 5> kCandidates{"m", "mm", "cm", "inch", "foot"};
constexpr std::size_t kListedUnits = 3;

bool isUsual(const UnitEvidence& evidence) {
    return evidence.extent >= kUsualPlan && evidence.extent <= kLargestUsualPlan;
}

bool hasPlanSize(const UnitEvidence& evidence) {
    return evidence.extent >= kSmallPlan && evidence.extent <= kLargePlan;
}

/// Returns the value at half of the weight; 0 for none.
double weightedMedian(std::vector<std::pair<double, double>> values) {
    std::sort(values.begin(), values.end());
    double all = 0, passed = 0;
    for (const auto& [value, weight] : values) all += weight;
    for (const auto& [value, weight] : values)
        if (passed += weight; 2 * passed >= all) return value;
    return 0;
}

/// Metres: a drawing of such a width is measured as it was read first, others as if so wide.
constexpr double kNarrowReading = 5, kWideReading = 100, kReading = 20;

/// A drawing at the scale at which it is measured.
struct Reading {
    double metres = 0;  ///< a unit of the drawing
    std::vector<PlanPath> paths;
    std::vector<Segment2> lines;
    Box2 box;
    std::optional<ParallelLines> parallels;

    [[nodiscard]] double extent() const { return std::max(box.width(), box.depth()); }
};

/// Reads a drawing at a scale at which curves have as many pieces as those of a plan.
void readUsualSize(const std::function<LayerSorter::Sorted(double)>& read, Reading& out) {
    out.metres = 0.001;
    for (const bool is_first : {true, false}) {
        LayerSorter::Sorted shapes = read(out.metres);
        out.paths = std::move(shapes.walls);
        for (PlanShape& door : shapes.doors) out.paths.push_back(std::move(door.path));
        out.lines = pathPieces(out.paths);
        if (out.lines.empty()) return;
        out.box = boundsOf(out.lines);
        const double extent = out.extent();
        if (!is_first || !(extent > 0) || (extent >= kNarrowReading && extent <= kWideReading))
            break;
        out.metres *= kReading / extent;
    }
    if (out.lines.size() <= kMaxLines) out.parallels.emplace(out.lines);
}

/// \param scale from the reading to the unit
void measureWalls(Reading& drawing, double scale, Budget& work, UnitEvidence& out) {
    double whole = 0, paired = 0;
    std::vector<std::pair<double, double>> walls;  // thickness and length
    for (std::size_t i = 0; i < drawing.lines.size(); ++i) {
        const double length = distance(drawing.lines[i].a, drawing.lines[i].b);
        whole += length;
        const auto apart = drawing.parallels->otherSide(drawing.lines[i], scale, work);
        if (!apart) continue;
        walls.emplace_back(*apart * scale, length);
        paired += length;
    }
    out.walls = whole > 0 ? paired / whole : 0;
    out.wall_thickness = weightedMedian(std::move(walls));
}

void measureDoors(const Reading& drawing, double scale, Budget& work, UnitEvidence& out) {
    std::vector<PlanPath> paths = drawing.paths;
    for (PlanPath& path : paths)
        for (Point2& p : path.points) p = {scale * p.x, scale * p.y};
    std::vector<std::pair<double, double>> widths;
    for (const PlanShape& swing : takeDrawnDoors(std::move(paths), work).swings)
        for (const PlanChord& chord : swing.chords) {
            const double width = distance(*chord.center, chord.line.a);
            if (width >= kNarrowDoor && width <= kWideDoor) widths.emplace_back(width, 1);
        }
    out.doors = widths.size();
    out.door_width = weightedMedian(std::move(widths));
}

/// \throws FormatError: too many lines to compare
UnitEvidence evidenceIn(const LengthUnit& unit, Reading& drawing, Budget& work) {
    const double scale = unit.metres / drawing.metres;
    UnitEvidence evidence;
    evidence.unit = &unit;
    evidence.width = wholeMicrometres(scale * drawing.box.width());
    evidence.extent = wholeMicrometres(scale * drawing.extent());
    evidence.is_large = !drawing.parallels;
    if (evidence.is_large || !hasPlanSize(evidence)) return evidence;
    measureWalls(drawing, scale, work, evidence);
    measureDoors(drawing, scale, work, evidence);
    return evidence;
}

}  // namespace

std::span<const LengthUnit> usualUnits() {
    static const auto units = [] {
        std::array<LengthUnit, kCandidates.size()> all{};
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = *std::find_if(kLengthUnits.begin(), kLengthUnits.end(),
                                   [&](const LengthUnit& unit) {
                                       return std::string_view(unit.name) == kCandidates[i];
                                   });
        return all;
    }();
    return units;
}

/// Scores: a usual size is 1, another plan's size 0.5; walls add up to 1 and doors up to 2, each as
/// a share of the unit that has most of them. A tie keeps the order of the candidates.
std::vector<UnitEvidence> rankedUnits(const std::function<LayerSorter::Sorted(double)>& read,
                                      Budget work, const LengthUnit* stated,
                                      std::span<const LengthUnit> candidates) {
    std::vector<UnitEvidence> ranking;
    Reading drawing;
    readUsualSize(read, drawing);
    if (drawing.lines.empty()) return ranking;
    const auto add = [&](const LengthUnit& unit) {
        UnitEvidence evidence;
        try {
            evidence = evidenceIn(unit, drawing, work);
        } catch (const FormatError& /*too many lines to compare*/) {
            // Units are compared by the same measures.
            drawing.parallels.reset();
            for (UnitEvidence& other : ranking) {
                other.is_large = true;
                other.doors = 0;
                other.walls = 0;
            }
            evidence = evidenceIn(unit, drawing, work);
        }
        if (hasPlanSize(evidence)) ranking.push_back(evidence);
    };
    if (stated != nullptr) {
        add(*stated);
        if (!ranking.empty() && (ranking.front().doors > 0 || ranking.front().is_large ||
                                 (isUsual(ranking.front()) && ranking.front().walls >= kMostWalls)))
            return ranking;
    }
    for (const LengthUnit& unit : candidates)
        if (stated == nullptr || std::string_view(stated->name) != unit.name) add(unit);
    double most_doors = 0, most_walls = kFewWalls;
    for (const UnitEvidence& evidence : ranking) {
        most_doors = std::max(most_doors, static_cast<double>(evidence.doors));
        most_walls = std::max(most_walls, evidence.walls);
    }
    for (UnitEvidence& evidence : ranking) {
        evidence.score = (isUsual(evidence) ? 1 : 0.5) + evidence.walls / most_walls;
        if (most_doors > 0) evidence.score += 2 * static_cast<double>(evidence.doors) / most_doors;
    }
    std::stable_sort(
        ranking.begin(), ranking.end(),
        [](const UnitEvidence& a, const UnitEvidence& b) { return a.score > b.score; });
    return ranking;
}

const UnitEvidence* decidedUnit(const std::vector<UnitEvidence>& ranking,
                                const LengthUnit* stated) {
    if (ranking.empty()) return nullptr;
    const UnitEvidence& best = ranking.front();
    if (best.unit == stated || (best.doors == 0 && best.walls < kMostWalls)) return nullptr;
    if (ranking.size() > 1 && best.score < ranking[1].score + kLead) return nullptr;
    const auto own =
        std::find_if(ranking.begin(), ranking.end(),
                     [&](const UnitEvidence& evidence) { return evidence.unit == stated; });
    if (own == ranking.end()) return &best;
    const bool is_sure = own->doors == 0 && best.doors >= kSureDoors && best.walls >= own->walls;
    return is_sure ? &best : nullptr;
}

std::string optionOf(const UnitEvidence& evidence) {
    const std::string unit = evidence.unit->name;
    return unit.starts_with("1:") ? "--width-is " + formatFixed(evidence.width, 2)
                                  : "--units " + unit;
}

std::string scaleHint(const std::vector<UnitEvidence>& ranking) {
    if (ranking.empty()) return std::string(": ") + kScaleHint;
    std::string text;
    for (std::size_t i = 0; i < std::min(ranking.size(), kListedUnits); ++i)
        text += std::string(i == 0 ? "; most likely is " : ", then ") + ranking[i].unit->name +
                ", in which " + evidenceText(ranking[i]);
    const std::string option = optionOf(ranking.front());
    const std::string width = "--width-is " + formatFixed(ranking.front().width, 2);
    return text + ": say " +
           (option == width
                ? "how wide it is, for example with " + width
                : "its unit, for example with " + option + ", or how wide it is, with " + width);
}

std::string evidenceText(const UnitEvidence& evidence) {
    std::string text;
    if (evidence.doors > 0)
        text += "doors are " + formatFixed(evidence.door_width, 2) + " m wide, ";
    if (evidence.walls >= kFewWalls)
        text += "walls " + std::string(text.empty() ? "are " : "") +
                formatFixed(evidence.wall_thickness, 2) + " m thick, ";
    if (!text.empty()) text.replace(text.size() - 2, 2, " and ");
    return text + "the plan " + (text.empty() ? "is " : "") + formatFixed(evidence.extent, 1) +
           " m wide";
}

}  // namespace ispace
