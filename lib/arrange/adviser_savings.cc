// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions about furniture, and those that save a sensor or its cost.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrange/adviser.h"
#include "arrange/placement_rules.h"
#include "base/number.h"
#include "env/element_schemas.h"
#include "scene/findings/findings.h"

namespace ispace {

namespace {

constexpr std::size_t kMaxPieces = 6;           // of furniture that are measured
constexpr double kPieceShifts[] = {0.5, 1, 2};  // metres

/// Bounds the floor that a round piece can hide from a sensor: the sector behind it.
double hiddenArea(const Sensor& sensor, Point2 middle, double radius) {
    const double range = std::min(maxRange(sensor.model), 100.0);
    const double distance = length(middle - sensor.pose.position.onFloor());
    if (distance >= range) return 0;
    const double half = distance > radius ? std::asin(radius / distance) : std::numbers::pi;
    return half * (range * range - distance * distance);
}

}  // namespace

std::optional<Suggestion> Adviser::furniture(const MeasuredState& now) {
    struct Piece {
        std::string id;
        double hidden;
    };
    std::vector<Piece> pieces;
    for (const Element& element : now.scene.environment.elements()) {
        const std::string& keyword = element.record.keyword();
        if (!standsByItself(element.record) || keyword == "pillar" || keyword == "floor") continue;
        const PlacementFrame frame = standingOf(element.record);
        const double radius = std::hypot(frame.length, frame.width) / 2;
        double hidden = 0;
        for (const Sensor& sensor : standingSensors(now.scene))
            hidden += hiddenArea(sensor, frame.world_from_body.position, radius);
        if (hidden > 0) pieces.push_back({element.id, hidden});
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.hidden > b.hidden; });
    if (pieces.size() > kMaxPieces) pieces.resize(kMaxPieces);
    const FindingFilter filter{.checks = {"objects", "outside", "buried", "collisions"}};
    const std::size_t accepted = checkScene(now.scene, filter).size();
    std::optional<Suggestion> best;
    for (const Piece& piece : pieces) {
        if (best && mostWithout(now, piece.id) <= best->gained) continue;
        for (const Vec2 by : displacements(kPieceShifts)) {
            if (isStopped()) return best;
            std::vector<Edit> edits = {moveOf(piece.id, by)};
            Scene moved =
                makeScene(edited(now.scene.records, edits, sceneSchemas()), now.scene, devices_);
            if (checkScene(moved, filter).size() > accepted) continue;
            offer(best, measured(now, Suggestion::Kind::Furniture,
                                 "move " + piece.id + " by (" + formatFixed(by.x, 2) + ", " +
                                     formatFixed(by.y, 2) + ") m",
                                 std::move(edits)));
        }
    }
    return best;
}

/// Bounds the floor gained by moving a piece by that gained without it; infinite where less
/// furniture may be worse, or is not known to help.
double Adviser::mostWithout(const MeasuredState& now, const std::string& id) {
    constexpr double kUnknown = std::numeric_limits<double>::infinity(), kRounding = 1e-6;
    if (now.missing > 0 || !options_.privacy.empty() || !options_.facing.empty()) return kUnknown;
    try {
        const std::vector<Edit> edits = {parseEdit(Edit::Kind::Delete, id)};
        const MeasuredState then = after(now, edits);
        if (then.coverage.report.indoor_area != now.coverage.report.indoor_area) return kUnknown;
        return (coveredShare(then.coverage) - coveredShare(now.coverage)) *
                   now.coverage.report.indoor_area +
               kRounding;
    } catch (const UsageError&) {  // something stands on it
        return kUnknown;
    }
}

std::optional<Suggestion> Adviser::replacement(const MeasuredState& now) {
    struct Device {
        std::string keyword, model;
        double cost;
    };
    std::vector<Device> known;
    for (const Record& record : now.scene.records)
        if (sensorKind(record.keyword()) != nullptr && record.has("model") && record.has("cost"))
            known.push_back({record.keyword(), record.text("model"), record.number("cost")});
    std::optional<Suggestion> best;
    for (std::size_t i = 0; i < now.scene.records.size(); ++i) {
        const Record& record = now.scene.records[i];
        if (sensorKind(record.keyword()) == nullptr || !record.has("model")) continue;
        std::optional<Device> cheapest;
        for (const Device& device : known)
            if (device.keyword == record.keyword() && device.cost < record.number("cost") &&
                (!cheapest || device.cost < cheapest->cost))
                cheapest = device;
        if (!cheapest || isStopped()) continue;
        const std::string& id = now.scene.ids[i];
        Suggestion suggestion =
            measured(now, Suggestion::Kind::Replace, "replace " + id + " by a " + cheapest->model,
                     {parseEdit(Edit::Kind::Set, id + ".model=" + cheapest->model),
                      parseEdit(Edit::Kind::Set, id + ".cost=" + formatDouble(cheapest->cost))});
        suggestion.saved = record.number("cost") - cheapest->cost;
        const bool is_cheap = -suggestion.gained <= kNegligible * now.coverage.report.indoor_area &&
                              suggestion.required >= 0;
        if (is_cheap && (!best || suggestion.saved > best->saved)) best = std::move(suggestion);
    }
    return best;
}

std::optional<Suggestion> Adviser::removal(const MeasuredState& now) {
    const SensorMetrics* least = nullptr;
    const auto marginal_of = [](const SensorMetrics& sensor) {
        return sensor.marginal.exact.value_or(sensor.marginal.grid.value_or(0));
    };
    for (const Sensor& sensor : standingSensors(now.scene))
        for (const SensorMetrics& metrics : now.coverage.report.sensors)
            if (metrics.id == sensor.id && (!least || marginal_of(metrics) < marginal_of(*least)))
                least = &metrics;
    if (least == nullptr || now.coverage.report.sensors.size() < 2 ||
        marginal_of(*least) > kNegligible * now.coverage.report.indoor_area)
        return std::nullopt;
    const auto at = std::find(now.scene.ids.begin(), now.scene.ids.end(), least->id);
    Suggestion suggestion = measured(now, Suggestion::Kind::Remove, "remove " + least->id,
                                     {parseEdit(Edit::Kind::Delete, least->id)});
    const Record& record = now.scene.records[static_cast<std::size_t>(at - now.scene.ids.begin())];
    if (record.has("cost")) suggestion.saved = record.number("cost");
    if (suggestion.required < 0) return std::nullopt;
    return suggestion;
}

}  // namespace ispace
