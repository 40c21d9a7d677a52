// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/private_floor.h"

#include <algorithm>
#include <optional>
#include <string>
#include <variant>

#include "coverage/coverage.h"
#include "coverage/metrics.h"
#include "env/zone.h"
#include "geom/curve_clip.h"
#include "geom/overlay/overlay.h"
#include "scene/sensor/camera.h"

namespace ispace::camerarules {

namespace {

constexpr std::uint64_t kPrivateMark = 2;

double areaInBoth(const std::vector<Curve>& floor, const std::vector<Curve>& view) {
    const std::vector<Layer> layers = {markLayer(floor, kPrivateMark),
                                       {.curves = cutAlong(view, boundsOfAll(floor)).inside}};
    double sum = 0;
    forEachArea(layers, [&](const LayerLabel& label, double area) {
        if (label.marks == kPrivateMark && label.count > 0) sum += area;
    });
    return std::max(0.0, sum);
}

}  // namespace

PrivateFloor::PrivateFloor(const Environment& environment, double plane,
                           std::span<const PrivacyRule> rules)
    : environment_(environment), sight_(environment_, plane) {
    sight_.keepRegions();
    for (const PrivacyRule& rule : rules) {
        Rule& own = rules_.emplace_back(Rule{rule.density, {}});
        for (const std::string& id : privateZones(rule, environment_)) {
            const std::vector<Layer> layers = {
                markLayer(curvesWithArcs(environment_.indoor()), kIndoorMark),
                markLayer({curveOf(readZone(id, environment_).outline)}, kPrivateMark)};
            const auto is_private = [](const LayerLabel& label) {
                return label.marks == (kIndoorMark | kPrivateMark);
            };
            Piece piece;
            piece.floor = Overlay(layers).curves(is_private);
            if (piece.floor.empty()) continue;
            piece.box = boundsOfAll(piece.floor);
            forEachArea(layers, [&](const LayerLabel& label, double area) {
                if (is_private(label)) piece.area += area;
            });
            own.pieces.push_back(std::move(piece));
        }
    }
}

PrivateFloor::Sight PrivateFloor::seenBy(const Sensor& sensor) const {
    Sight sum;
    if (!sensor.is<Camera>()) return sum;
    for (const Rule& rule : rules_) {
        Sensor camera = sensor;
        camera.model = withDensity(sensor.as<Camera>(), rule.density);
        const Box2 reach = sight_.boxOf(camera);
        if (std::none_of(rule.pieces.begin(), rule.pieces.end(),
                         [&](const Piece& piece) { return reach.meets(piece.box); }))
            continue;
        const std::optional<std::vector<Curve>> view = sight_.regionOf(camera);
        const Box2 box = view ? boundsOfAll(*view) : Box2();
        for (const Piece& piece : rule.pieces) {
            if (view && !box.meets(piece.box)) continue;
            const double seen = view ? areaInBoth(piece.floor, *view) : piece.area;
            sum.all += seen;
            if (!view || seen > kMinPiece) sum.broken += seen;
        }
    }
    return sum;
}

const PrivateFloor::Sight& PrivateFloor::knownSight(const Sensor& sensor) {
    static const Sight none;
    if (!sensor.is<Camera>()) return none;
    const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& one) {
        return one.pose == sensor.pose && one.model == sensor.model;
    });
    if (known != known_.end()) return known->sight;
    return known_.emplace_back(Known{sensor.model, sensor.pose, seenBy(sensor)}).sight;
}

}  // namespace ispace::camerarules
