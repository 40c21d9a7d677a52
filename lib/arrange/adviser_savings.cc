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
#include "arrange/coarse_sight.h"
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
    std::vector<Move> moves;
    for (const Piece& piece : pieces)
        for (const Vec2 by : displacements(kPieceShifts)) moves.push_back({piece.id, by});
    keepPromising(now, moves);
    progress_.begin("best moves of furniture", static_cast<std::int64_t>(moves.size()));
    std::optional<Suggestion> best;
    for (const Move& move : moves) {
        if (isStopped()) break;
        progress_.advance(1);
        offer(best, measured(now, Suggestion::Kind::Furniture,
                             "move " + move.id + " by (" + formatFixed(move.by.x, 2) + ", " +
                                 formatFixed(move.by.y, 2) + ") m",
                             {moveOf(move.id, move.by)}));
    }
    return best;
}

/// Leaves out moves that add findings, and those that by estimates of cells cannot be the best.
void Adviser::keepPromising(const MeasuredState& now, std::vector<Move>& moves) {
    const FindingFilter filter{.checks = {"objects", "outside", "buried", "collisions"}};
    const std::size_t accepted = checkScene(now.scene, filter).size();
    const bool estimates = CoarseSight::estimates(now.scene, options_);
    std::vector<Move> kept;
    std::vector<FloorGain> gains;
    double error = 0;
    progress_.begin("moves of furniture", static_cast<std::int64_t>(moves.size()));
    for (const Move& move : moves) {
        if (isStopped()) break;
        progress_.advance(1);
        const std::vector<Edit> edits = {moveOf(move.id, move.by)};
        const Scene moved =
            makeScene(edited(now.scene.records, edits, sceneSchemas()), now.scene, devices_);
        if (checkScene(moved, filter).size() > accepted) continue;
        kept.push_back(move);
        if (!estimates) continue;
        CoarseSight coarse(moved.environment, options_);
        gains.push_back(coarse.whole(moved.sensors));
        error = coarse.error();
    }
    moves.clear();
    const FloorGain most =
        gains.empty() ? FloorGain() : *std::max_element(gains.begin(), gains.end());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const bool may_be_best =
            !estimates || (gains[i].required + error >= most.required &&
                           (gains[i].gained + error >= most.gained || !options_.privacy.empty()));
        if (may_be_best) moves.push_back(kept[i]);
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
