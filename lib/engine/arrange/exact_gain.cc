// SPDX-License-Identifier: GPL-3.0-or-later
// The area that a sensor adds at many poses, exactly.
//
// An overlay of all regions for each pose would take O(n log n) in all of them. Instead, the floor
// that lacks exactly one more sensor is computed once, about the sensor that moves (look()); the
// gain of a pose is then the area that its region shares with that floor, an overlay without the
// others. The box about the sensor grows when a pose leaves it: gains are of whole regions, so
// those of different boxes compare. prepareAll() computes for all sensors at once which floor is
// unseen and which only one of them sees: the others' lines vanish from one overlay (label
// `coarse`).
//
// A label packs counts: receivers above the low 32 bits of `numbers`, all other sensors in these;
// four receivers together count as one sensor. Mark i is floor of weight i, mark 63 the box.
#include "arrange/refine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "arrange/floor_tiles.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "geom/overlay/overlay.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

namespace {

/// Increments of LayerLabel::numbers per counted layer: lasers and rangers count in the low digits,
/// receivers in the high ones.
constexpr std::int64_t kOneSet = 1, kOneReceiver = std::int64_t{1} << 32;
constexpr std::uint64_t kNearMark = std::uint64_t{1} << 63;

/// Floor of one weight.
struct Floor {
    double weight = 1;
    std::vector<Curve> curves;
    Box2 box;
};

Polygon cornersOf(const Box2& box) {
    return {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
}

Layer markLayer(std::vector<Curve> curves, std::uint64_t marks) {
    return {.curves = std::move(curves), .counts = false, .marks = marks};
}

/// Splits the indoor floor that counts by its weight; skips floor of weight 0.
std::vector<Floor> floorsOf(const Environment& environment, const FloorWeights& floor) {
    std::vector<Floor> floors;
    if (floor.isUniform()) {
        floors.push_back({1, curvesWithArcs(environment.indoor()), {}});
    } else {
        constexpr std::uint64_t kIndoor = 1;
        constexpr std::size_t kFirstWeight = 1;
        std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoor)};
        layers.reserve(1 + floor.targets.size() + floor.weights.size());
        for (const NamedZone& zone : floor.targets)
            layers.push_back({.curves = {curveOf(zone.outline)}});
        std::set<double> weights = {1};
        for (std::size_t i = 0; i < floor.weights.size(); ++i) {
            layers.push_back(markLayer({curveOf(floor.weights[i].first.outline)},
                                       std::uint64_t{1} << (kFirstWeight + i)));
            weights.insert(floor.weights[i].second);
        }
        const auto weight_of = [&](const LayerLabel& label) {
            if ((label.marks & kIndoor) == 0) return 0.0;
            if (label.count == 0 && !floor.targets.empty()) return 0.0;
            for (std::size_t i = floor.weights.size(); i > 0; --i)
                if ((label.marks >> (kFirstWeight + i - 1) & 1U) != 0)
                    return floor.weights[i - 1].second;
            return 1.0;
        };
        const Overlay overlay(layers);
        for (const double weight : weights) {
            if (weight <= 0) continue;
            const auto weighs = [&](const LayerLabel& label) { return weight_of(label) == weight; };
            floors.push_back({weight, overlay.curves(weighs), {}});
        }
    }
    for (Floor& floor : floors) floor.box = boundsOfAll(floor.curves);
    return floors;
}

/// A sensor's region as a layer.
struct View {
    Layer layer;
    Box2 box;

    View(std::vector<Curve> curves, bool is_receiver)
        : layer{.curves = std::move(curves), .number = is_receiver ? kOneReceiver : kOneSet} {
        box = boundsOfAll(layer.curves);
    }
};

}  // namespace

struct ExactGain::Data {
    std::span<const Sensor> sensors;  // the moving sensors
    int multiplicity;
    const VisibleArea& sight;
    std::vector<Floor> floors = {};
    Box2 floor_box = {};
    std::vector<View> standing = {}, moving = {};
    std::vector<std::shared_ptr<const Level>> levels =
        {};  // of these sensors, fixed while they move

    /// The selected sensor: the floor that lacks exactly one more sensor, within `near`.
    std::size_t in_hand = 0;
    Box2 near = {};
    /// The floors within a wider box around each sensor; computed on demand.
    struct Surroundings {
        Box2 box;
        std::vector<Floor> floors;
    };
    std::vector<Surroundings> around = {};

    /// A layer of missing floor with the boxes of its curves.
    struct Missing {
        Layer layer;
        std::vector<Box2> boxes;

        explicit Missing(Layer floor) : layer(std::move(floor)) {
            for (const Curve& curve : layer.curves) boxes.push_back(boundsOfAll({&curve, 1}));
        }
        /// Adds the curves that a box meets: the others do not divide it, and it lies outside them.
        void addIn(const Box2& box, std::vector<Layer>& layers) const {
            std::vector<Curve> near;
            for (std::size_t i = 0; i < boxes.size(); ++i)
                if (boxes[i].meets(box)) near.push_back(layer.curves[i]);
            if (!near.empty()) layers.push_back(markLayer(std::move(near), layer.marks));
        }
    };
    std::vector<Missing> missing = {};  // of the selected sensor; marks 1 << i: of floors[i]
    /// Of prepareAll(), until put(): floor that no sensor sees, and that one of them alone sees.
    bool is_prepared = false;
    std::vector<Missing> unseen = {};
    /// Floor that one more sensor covers: any but a receiver, or a receiver.
    std::optional<FloorTiles> unseen_tiles = {}, unheard_tiles = {};
    std::vector<std::vector<Missing>> alone = {};

    [[nodiscard]] View viewOf(const Sensor& sensor) const {
        auto region = sight.regionOf(sensor);
        if (!region)
            throw UsageError(sensor.id + " cannot be refined: its exact region is not known");
        return {std::move(*region), isPartial(sensor.model)};
    }
    [[nodiscard]] View viewOf(std::size_t sensor, const Pose3& pose) const {
        return viewOf({sensors[sensor].id, sensors[sensor].model, pose});
    }

    [[nodiscard]] static std::int64_t setsAt(const LayerLabel& label) {
        const bool heard = label.numbers / kOneReceiver >= static_cast<std::int64_t>(kMinReceivers);
        return label.numbers % kOneReceiver + (heard ? 1 : 0);
    }
    /// Returns true where one more sensor of this kind covers the floor.
    [[nodiscard]] bool lacksOne(const LayerLabel& label, bool is_receiver) const {
        if (setsAt(label) != multiplicity - 1) return false;
        return !is_receiver ||
               label.numbers / kOneReceiver == static_cast<std::int64_t>(kMinReceivers) - 1;
    }

    static void addFloors(const std::vector<Floor>& floors, std::vector<Layer>& layers) {
        for (std::size_t i = 0; i < floors.size(); ++i)
            if (!floors[i].curves.empty())
                layers.push_back(markLayer(floors[i].curves, std::uint64_t{1} << i));
    }

    /// Returns the floors in a box around the selected sensor that contains `near`.
    const std::vector<Floor>& floorsNear() {
        constexpr double kReach = 3;  // metres that a sensor may move before they are computed anew
        Surroundings& own = around[in_hand];
        if (!own.floors.empty() && own.box.contains(near)) return own.floors;
        own.box = near.expanded(kReach);
        if (own.box.contains(floor_box)) {
            own.floors = floors;
            return own.floors;
        }
        own.floors.assign(floors.size(), {});
        for (std::size_t i = 0; i < floors.size(); ++i) {
            own.floors[i].weight = floors[i].weight;
            if (!floors[i].box.meets(own.box)) continue;
            const std::vector<Layer> layers = {markLayer(floors[i].curves, 1),
                                               {.curves = {curveOf(cornersOf(own.box))}}};
            own.floors[i].curves = Overlay(layers).curves(
                [](const LayerLabel& label) { return label.marks == 1 && label.count == 1; });
        }
        return own.floors;
    }

    /// Computes `missing` for a selected sensor whose region lies in this box, which may be empty.
    void look(const Box2& region) {
        constexpr double kReach = 0.6;  // metres; longer steps occur
        missing.clear();
        near = {};
        if (region.empty()) return;
        near = region.expanded(kReach);
        // Only floor and views near the sensor take part; the box itself is a mark, so that floor
        // outside of it is left out.
        std::vector<Layer> layers = {markLayer({curveOf(cornersOf(near))}, kNearMark)};
        addFloors(floorsNear(), layers);
        for (const View& view : standing)
            if (view.box.meets(near)) layers.push_back(view.layer);
        for (std::size_t i = 0; i < moving.size(); ++i)
            if (i != in_hand && moving[i].box.meets(near)) layers.push_back(moving[i].layer);
        const Overlay overlay(layers);
        const bool is_receiver = isPartial(sensors[in_hand].model);
        for (std::size_t i = 0; i < floors.size(); ++i) {
            const std::uint64_t mark = std::uint64_t{1} << i;
            std::vector<Curve> curves = overlay.curves([&](const LayerLabel& label) {
                return label.marks == (mark | kNearMark) && lacksOne(label, is_receiver);
            });
            if (!curves.empty()) missing.emplace_back(markLayer(std::move(curves), mark));
        }
    }

    /// One overlay for all sensors: what one sensor alone sees is what moving it may lose, so each
    /// later move needs that and the unseen floor only.
    void prepareAll() {
        std::vector<Layer> layers;
        addFloors(floors, layers);
        for (const View& view : standing) layers.push_back(view.layer);
        for (Layer& layer : layers) layer.number = 0;
        for (std::size_t i = 0; i < moving.size(); ++i) {
            layers.push_back(moving[i].layer);
            layers.back().number = static_cast<std::int64_t>(i) + 1;
        }
        // Floor that several see is one face, without the lines of their views.
        const auto coarse = [](const LayerLabel& label) {
            return label.marks == 0 || label.count > 1 ? LayerLabel() : label;
        };
        const Overlay overlay(layers, {},
                              {.label = coarse, .add_area = [](const LayerLabel&, double) {}});
        // Labels become sets, so that one pass over the faces finds the curves of all.
        // A set for each floor and moving sensor, after one for each floor that none sees.
        const std::size_t sets_of_floor = moving.size() + 1;
        const std::size_t none = floors.size() * sets_of_floor;
        const auto set_of = [&](const LayerLabel& label) {
            if (!std::has_single_bit(label.marks)) return none;
            const auto first =
                static_cast<std::size_t>(std::countr_zero(label.marks)) * sets_of_floor;
            if (label.count == 0) return first;
            const bool is_own = label.count == 1 && label.numbers > 0;
            return is_own ? first + static_cast<std::size_t>(label.numbers) : none;
        };
        auto curves = overlay.curvesOfSets(none, set_of);
        alone.resize(moving.size());
        for (std::size_t set = 0; set < none; ++set) {
            if (curves[set].empty()) continue;
            const std::size_t sensor = set % sets_of_floor;
            (sensor == 0 ? unseen : alone[sensor - 1])
                .emplace_back(
                    markLayer(std::move(curves[set]), std::uint64_t{1} << (set / sets_of_floor)));
        }
        unseen_tiles.emplace(floor_box);
        for (const Missing& floor : unseen)
            unseen_tiles->add(floor.layer.curves, weightOf(floor.layer.marks));
        is_prepared = true;
    }

    /// Computes the tiles alone.
    void prepareBounds() {
        std::vector<Layer> layers;
        addFloors(floors, layers);
        for (const std::vector<View>* const views : {&standing, &moving})
            for (const View& view : *views) layers.push_back(view.layer);
        // Floor to which one more adds no area is one face.
        const auto coarse = [this](const LayerLabel& label) {
            return label.marks == 0 || !lacksOne(label, false) ? LayerLabel() : label;
        };
        const Overlay overlay(layers, {},
                              {.label = coarse, .add_area = [](const LayerLabel&, double) {}});
        for (const bool is_receiver : {false, true}) {
            std::optional<FloorTiles>& tiles = is_receiver ? unheard_tiles : unseen_tiles;
            tiles.emplace(floor_box);
            for (std::size_t i = 0; i < floors.size(); ++i) {
                const std::uint64_t mark = std::uint64_t{1} << i;
                tiles->add(overlay.curves([&](const LayerLabel& label) {
                    return label.marks == mark && lacksOne(label, is_receiver);
                }),
                           floors[i].weight);
            }
        }
    }

    /// Returns the layers of floor in a box that lacks exactly the selected sensor.
    [[nodiscard]] std::vector<Layer> missingIn(const Box2& box) const {
        std::vector<Layer> layers;
        if (!is_prepared) {
            for (const Missing& floor : missing) floor.addIn(box, layers);
            return layers;
        }
        for (const Missing& floor : unseen) floor.addIn(box, layers);
        for (const Missing& floor : alone[in_hand]) floor.addIn(box, layers);
        return layers;
    }

    [[nodiscard]] double weightOf(std::uint64_t marks) const {
        return marks == 0 ? 0 : floors[static_cast<std::size_t>(std::countr_zero(marks))].weight;
    }

    [[nodiscard]] double gainOf(const View& view) const {
        if (view.layer.curves.empty()) return 0;
        std::vector<Layer> layers = missingIn(view.box);
        if (layers.empty()) return 0;
        layers.push_back(view.layer);
        double gain = 0;
        Overlay(layers).addAreas([&](const LayerLabel& label, double area) {
            if (label.count > 0) gain += weightOf(label.marks) * area;
        });
        return gain;
    }
};

ExactGain::ExactGain(const Scene& scene, const VisibleArea& sight, std::span<const Sensor> sensors,
                     const FloorWeights& weights, int multiplicity)
    : data_(new Data{sensors, multiplicity, sight}) {
    if (weights.weights.size() > kMaxZones)
        throw UsageError("sensors cannot be refined for " + std::to_string(weights.weights.size()) +
                         " weighted zones, wanted at most " + std::to_string(kMaxZones));
    data_->floors = floorsOf(scene.environment, weights);
    for (const Floor& floor : data_->floors) {
        if (floor.box.empty()) continue;
        data_->floor_box.add(floor.box.low);
        data_->floor_box.add(floor.box.high);
    }
    for (const Sensor& sensor : scene.sensors)
        if (kindOf(sensor.model).perceives) data_->standing.push_back(data_->viewOf(sensor));
    data_->moving.reserve(sensors.size());
    for (const Sensor& sensor : sensors) {
        data_->levels.push_back(sight.levelAt(sensor.pose.position.z));
        data_->moving.push_back(data_->viewOf(sensor));
    }
    data_->around.resize(sensors.size());
}
ExactGain::~ExactGain() = default;

double ExactGain::total() const {
    double sum = 0;
    for (const Floor& floor : data_->floors) sum += floor.weight * signedArea(floor.curves);
    return sum;
}

double ExactGain::value() const {
    std::vector<Layer> layers;
    Data::addFloors(data_->floors, layers);
    for (const View& view : data_->standing) layers.push_back(view.layer);
    for (const View& view : data_->moving) layers.push_back(view.layer);
    double value = 0;
    Overlay(layers).addAreas([&](const LayerLabel& label, double area) {
        if (Data::setsAt(label) >= data_->multiplicity)
            value += data_->weightOf(label.marks) * area;
    });
    // Floor that is seen as a whole adds up to its area in another order.
    return std::clamp(value, 0.0, std::max(0.0, total()));
}

bool ExactGain::prepareAll() {
    if (data_->multiplicity != 1) return false;
    for (const std::vector<View>& views : {std::cref(data_->standing), std::cref(data_->moving)})
        for (const View& view : views)
            if (view.layer.number != kOneSet) return false;
    data_->prepareAll();
    return true;
}

void ExactGain::prepareBounds() { data_->prepareBounds(); }

double ExactGain::mostMore(const Pose3& pose) const {
    const Sensor& own = data_->sensors[data_->in_hand];
    const auto& tiles = isPartial(own.model) ? data_->unheard_tiles : data_->unseen_tiles;
    if (!tiles) return std::numeric_limits<double>::infinity();
    const double most = tiles->mostIn(data_->sight.boxOf({own.id, own.model, pose}));
    // What it alone sees at its present pose is all that it may see again.
    constexpr double kNothing = 1e-6, kRounding = 1e-3;  // m2, of overlays
    return most <= kNothing ? 0 : most + kRounding;
}

void ExactGain::take(std::size_t sensor) {
    data_->in_hand = sensor;
    if (data_->is_prepared) return;
    data_->look(common(data_->moving[sensor].box, data_->floor_box));
}

std::vector<double> ExactGain::gains(std::span<const Pose3> poses) {
    std::vector<std::optional<View>> views(poses.size());
    tbb::parallel_for(std::size_t{0}, poses.size(),
                      [&](std::size_t i) { views[i] = data_->viewOf(data_->in_hand, poses[i]); });
    Box2 all;
    for (const auto& view : views) {
        if (data_->is_prepared) break;
        const Box2 box = common(view->box, data_->floor_box);
        if (data_->near.contains(box)) continue;
        all.add(box.low);
        all.add(box.high);
    }
    if (!all.empty()) {
        // Earlier gains stay comparable: gains are of whole regions.
        if (!data_->near.empty()) {
            all.add(data_->near.low);
            all.add(data_->near.high);
        }
        data_->look(all);
    }
    std::vector<double> gains(poses.size());
    tbb::parallel_for(std::size_t{0}, poses.size(),
                      [&](std::size_t i) { gains[i] = data_->gainOf(*views[i]); });
    return gains;
}

void ExactGain::put(const Pose3& pose) {
    data_->moving[data_->in_hand] = data_->viewOf(data_->in_hand, pose);
    data_->unseen_tiles.reset();
    data_->unheard_tiles.reset();
    if (!std::exchange(data_->is_prepared, false)) return;
    data_->unseen.clear();
    data_->alone.clear();
    take(data_->in_hand);
}

bool ExactGain::turns(std::size_t sensor) const {
    const Sensor& own = data_->sensors[sensor];
    return !isOmnidirectional(own.model, own.pose);
}

}  // namespace ispace
