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

#include "arrange/placement_rules.h"
#include "base/number.h"
#include "env/element_schemas.h"
#include "extensions/advice/adviser.h"
#include "extensions/advice/coarse_sight.h"
#include "extensions/advice/suggested_moves.h"
#include "scene/findings/findings.h"

namespace ispace::advice {

namespace {

// What reaches within 0.1 m of the walls' top is built in: stairs, chimneys.
constexpr double kBuiltInGap = 0.1, kLowestCeiling = 2.2;  // metres
constexpr std::size_t kMaxPieces = 6;                      // of furniture that are measured
constexpr double kPieceShifts[] = {0.5, 1, 2};             // metres

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
    const std::vector<Sensor> sensors = standingSensors(now.scene);
    const double ceiling = std::max(now.scene.environment.height(), kLowestCeiling);
    for (const Element& element : now.scene.environment.elements()) {
        const std::string& keyword = element.record.keyword();
        if (!standsByItself(element.record) || keyword == "pillar" || keyword == "floor") continue;
        const PlacementFrame frame = standingOf(element.record);
        if (frame.top >= ceiling - kBuiltInGap) continue;
        const double radius = std::hypot(frame.length, frame.width) / 2;
        double hidden = 0;
        for (const Sensor& sensor : sensors)
            hidden += hiddenArea(sensor, frame.world_from_body.position, radius);
        if (hidden > 0) pieces.push_back({element.id, hidden});
    }
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.hidden > b.hidden; });
    if (pieces.size() > kMaxPieces) pieces.resize(kMaxPieces);
    std::vector<std::string> ids;
    ids.reserve(pieces.size());
    for (const Piece& piece : pieces) ids.push_back(piece.id);
    std::vector<Move> moves;
    if (MoveTrials::areKnown(now.scene, now.coverage, options_)) {
        moves = promisingMoves(now, ids);
    } else {
        moves = movesOf(ids);
        keepPromising(now, moves);
    }
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

std::vector<Adviser::Move> Adviser::movesOf(const std::vector<std::string>& pieces) const {
    std::vector<Move> moves;
    for (const std::string& piece : pieces)
        for (const Vec2 by : displacements(kPieceShifts)) moves.push_back({piece, by});
    return moves;
}

Scene Adviser::sceneAfter(const MeasuredState& now, const Move& move) const {
    const std::vector<Edit> edits = {moveOf(move.id, move.by)};
    return makeScene(edited(now.scene.records, edits, sceneSchemas()), now.scene, devices_);
}

std::size_t Adviser::findingsOf(const Scene& scene) {
    return checkScene(scene,
                      FindingFilter{.checks = {"objects", "outside", "buried", "collisions"}})
        .size();
}

namespace {

/// Returns the environment of a scene without one of its elements.
Environment roomWithout(const Scene& scene, const std::string& id) {
    std::vector<Record> records;
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (scene.ids[i] == id) continue;
        records.push_back(scene.records[i]);
        ids.push_back(scene.ids[i]);
    }
    return {records, ids, scene.environment};
}

}  // namespace

/// Returns the moves of these pieces, in order, that may be the best one by cells and add no
/// findings. No move of a piece shows more floor than the room without it, and findings are checked
/// only of moves that gain enough, the best first.
std::vector<Adviser::Move> Adviser::promisingMoves(const MeasuredState& now,
                                                   const std::vector<std::string>& pieces) {
    MoveTrials trials(now.scene, now.coverage, options_);
    const double error = trials.error();
    const double least = std::max(leastGain(now), 1e-9);
    std::vector<std::string> hiding;
    for (const std::string& piece : pieces) {
        if (isStopped()) return {};
        const auto most = trials.gainIn(roomWithout(now.scene, piece));
        if (!most || *most + error >= least) hiding.push_back(piece);
    }
    struct Trial {
        Move move;
        double most;
        std::size_t number;
    };
    std::vector<Trial> all;
    const std::vector<Move> moves = movesOf(hiding);
    progress_.begin("moves of furniture", static_cast<std::int64_t>(moves.size()));
    for (std::size_t i = 0; i < moves.size() && !isStopped(); ++i) {
        progress_.advance(1);
        const std::vector<Edit> edits = {moveOf(moves[i].id, moves[i].by)};
        const Environment moved(edited(now.scene.records, edits, sceneSchemas()), now.scene.ids,
                                now.scene.environment);
        const double most = trials.gainIn(moved).value_or(std::numeric_limits<double>::infinity());
        if (most + error >= least) all.push_back({moves[i], most, i});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Trial& a, const Trial& b) { return a.most > b.most; });
    const std::size_t accepted = all.empty() ? 0 : findingsOf(now.scene);
    double best = -std::numeric_limits<double>::infinity();
    std::vector<Trial> kept;
    for (const Trial& trial : all) {
        // Without an error equal gains are equal when measured, and the first of them is best.
        if (isStopped() || trial.most + error < best || (error == 0 && trial.most == best)) break;
        if (findingsOf(sceneAfter(now, trial.move)) > accepted) continue;
        best = std::max(best, trial.most);
        kept.push_back(trial);
    }
    std::sort(kept.begin(), kept.end(),
              [](const Trial& a, const Trial& b) { return a.number < b.number; });
    std::vector<Move> promising;
    promising.reserve(kept.size());
    for (Trial& trial : kept) promising.push_back(std::move(trial.move));
    return promising;
}

/// Leaves out moves that add findings, and those that by estimates of cells cannot be the best.
void Adviser::keepPromising(const MeasuredState& now, std::vector<Move>& moves) {
    const std::size_t accepted = findingsOf(now.scene);
    const bool estimates = CoarseSight::estimates(options_);
    std::vector<Move> kept;
    std::vector<FloorGain> gains;
    double error = 0;
    progress_.begin("moves of furniture", static_cast<std::int64_t>(moves.size()));
    for (const Move& move : moves) {
        if (isStopped()) break;
        progress_.advance(1);
        const Scene moved = sceneAfter(now, move);
        if (findingsOf(moved) > accepted) continue;
        kept.push_back(move);
        if (!estimates) continue;
        CoarseSight coarse(moved.environment, options_, CoarseSight::Cells::Few);
        // With private zones covered floor does not decide, see below.
        gains.push_back(options_.privacy.empty() ? coarse.whole(moved.sensors)
                                                 : FloorGain{coarse.privateOf(moved.sensors), 0});
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

}  // namespace ispace::advice
