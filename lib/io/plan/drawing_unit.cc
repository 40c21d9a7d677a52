// SPDX-License-Identifier: GPL-3.0-or-later
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
#include "io/plan/plan_lines.h"

namespace ispace {

namespace {

/// Metres.
constexpr double kNarrowDoor = 0.6, kWideDoor = 1.2;
constexpr double kThinWall = 0.08, kThickWall = 0.5;
constexpr double kSmallPlan = 2, kLargePlan = 500;         // impossible beyond
constexpr double kUsualPlan = 4, kLargestUsualPlan = 100;  // usual within
constexpr double kShortestSide = 0.4;                      // of a wall

/// Sine of the angle between the sides of a wall.
constexpr double kParallel = 0.01;
/// Share of the shorter side along which the other one faces it.
constexpr double kFacing = 0.5;
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

/// Returns the value at half of the weight; 0 for none.
double weightedMedian(std::vector<std::pair<double, double>> values) {
    std::sort(values.begin(), values.end());
    double all = 0, passed = 0;
    for (const auto& [value, weight] : values) all += weight;
    for (const auto& [value, weight] : values)
        if (passed += weight; 2 * passed >= all) return value;
    return 0;
}

/// Returns the distance of the nearest line that faces this one as the other side of a wall does.
std::optional<double> otherSide(std::size_t of, std::span<const Segment2> lines,
                                const NearSegments& search) {
    const auto [a, b] = lines[of];
    const double whole = distance(a, b);
    const Vec2 along = 1 / whole * (b - a);
    std::optional<double> nearest;
    for (const std::size_t i : search.near(bounds(lines[of]), kThickWall)) {
        const auto [c, d] = lines[i];
        const double length = distance(c, d);
        if (i == of || length < kShortestSide || std::abs(cross(along, d - c)) > kParallel * length)
            continue;
        const double apart = std::abs(cross(along, c + 0.5 * (d - c) - a));
        const auto [from, to] = std::minmax({dot(c - a, along), dot(d - a, along)});
        const double facing = std::min(whole, to) - std::max(0.0, from);
        if (apart >= kThinWall && apart <= kThickWall &&
            facing >= kFacing * std::min(whole, length) && (!nearest || apart < *nearest))
            nearest = apart;
    }
    return nearest;
}

void measureWalls(std::span<const Segment2> lines, Budget& work, UnitEvidence& out) {
    const NearSegments search(lines, work);
    double whole = 0;
    std::vector<std::pair<double, double>> walls;  // thickness and length
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const double length = distance(lines[i].a, lines[i].b);
        whole += length;
        if (length < kShortestSide) continue;
        if (const auto apart = otherSide(i, lines, search)) walls.emplace_back(*apart, length);
    }
    double paired = 0;
    for (const auto& [apart, length] : walls) paired += length;
    out.walls = whole > 0 ? paired / whole : 0;
    out.wall_thickness = weightedMedian(std::move(walls));
}

void measureDoors(std::vector<PlanPath> paths, Budget& work, UnitEvidence& out) {
    std::vector<std::pair<double, double>> widths;
    for (const PlanShape& swing : takeDrawnDoors(std::move(paths), work).swings)
        for (const PlanChord& chord : swing.chords) {
            const double width = distance(*chord.center, chord.line.a);
            if (width >= kNarrowDoor && width <= kWideDoor) widths.emplace_back(width, 1);
        }
    out.doors = widths.size();
    out.door_width = weightedMedian(std::move(widths));
}

UnitEvidence evidenceIn(const LengthUnit& unit, LayerSorter::Sorted shapes, Budget work) {
    UnitEvidence evidence;
    evidence.unit = &unit;
    std::vector<PlanPath> paths = std::move(shapes.walls);
    for (PlanShape& door : shapes.doors) paths.push_back(std::move(door.path));
    const std::vector<Segment2> lines = pathPieces(paths);
    if (lines.empty()) return evidence;
    const Box2 box = boundsOf(lines);
    evidence.extent = std::max(box.width(), box.depth());
    const bool has_size = evidence.extent >= kSmallPlan && evidence.extent <= kLargePlan;
    evidence.is_large = lines.size() > kMaxLines;
    if (!has_size || evidence.is_large) return evidence;
    try {
        measureWalls(lines, work, evidence);
        measureDoors(std::move(paths), work, evidence);
    } catch (const FormatError& /*too many lines to compare*/) {
        evidence.doors = 0;
        evidence.walls = 0;
    }
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

std::vector<UnitEvidence> rankedUnits(const std::function<LayerSorter::Sorted(double)>& read,
                                      const Budget& work, const LengthUnit* stated,
                                      std::span<const LengthUnit> candidates) {
    std::vector<UnitEvidence> ranking;
    const auto add = [&](const LengthUnit& unit) {
        const UnitEvidence evidence = evidenceIn(unit, read(unit.metres), work);
        if (evidence.extent >= kSmallPlan && evidence.extent <= kLargePlan)
            ranking.push_back(evidence);
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

std::string rankingText(const std::vector<UnitEvidence>& ranking) {
    std::string text;
    for (std::size_t i = 0; i < std::min(ranking.size(), kListedUnits); ++i)
        text += std::string(i == 0 ? "; most likely is " : ", then ") + ranking[i].unit->name +
                ", in which " + evidenceText(ranking[i]);
    return text;
}

std::string scaleHint(const std::vector<UnitEvidence>& ranking) {
    if (ranking.empty()) return std::string(": ") + kScaleHint;
    const UnitEvidence& best = ranking.front();
    const std::string width = "--width-is " + formatFixed(best.extent, 2);
    const bool is_scale = std::string_view(best.unit->name).starts_with("1:");
    return rankingText(ranking) + ": say " +
           (is_scale ? "how wide it is, for example with " + width
                     : std::string("its unit, for example with --units ") + best.unit->name +
                           ", or how wide it is, with " + width);
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
