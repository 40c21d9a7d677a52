// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/uwb_ranges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "env/point_location.h"
#include "geom/predicates.h"
#include "sense/noise.h"
#include "sense/walls_between.h"

namespace ispace {

namespace {

constexpr double kOffBody = 0.02;  // metres between a tag and the body that carries it
constexpr double kChest = 0.75;    // height of a person's tag, as a share of the trunk

/// Returns the position of a mover's tag; empty without a body.
std::optional<Point3> tagOnMover(const RfidTag& tag, const MovingBodies& bodies) {
    const bool is_person = tag.carrier == RfidTag::Carrier::Person;
    const auto mover = static_cast<std::uint32_t>(tag.mover);
    const std::uint32_t owner = is_person ? kFirstPerson + mover : mover;
    for (const MovingBody& body : bodies.bodies()) {
        // The trunk is a person's only box.
        if (body.owner != owner || (is_person && body.radius > 0)) continue;
        const double ahead = is_person ? body.half_length + kOffBody : 0;
        const Point2 at = body.pose * Point2{ahead, 0};
        const double height =
            is_person ? body.bottom + kChest * (body.top - body.bottom) : body.top + kOffBody;
        return Point3{at.x, at.y, height};
    }
    return std::nullopt;
}

std::optional<Point3> placeOf(const RfidTag& tag, const Moment& now) {
    if (tag.carrier == RfidTag::Carrier::Thing) return tag.at;
    return tagOnMover(tag, now.bodies);
}

/// Counts the walls between two points, and all movers as one.
int blocksBetween(Point3 from, Point3 to, std::uint32_t carrier, const Moment& now,
                  bool with_movers = true) {
    if (from == to) return 0;
    std::uint8_t is_free = 0;
    now.mesh().query(from, std::span(&to, 1), std::span(&is_free, 1));
    // A surface that ends touch is none between.
    const int walls = is_free != 0 ? 0 : std::max(1, wallsBetween(from, to, now.mesh()));
    return walls + (with_movers && now.bodies.between(from, to, carrier) ? 1 : 0);
}

struct Ranging {
    double range = 0;
    int blocks = 0;
};

/// Adds the errors of a range; empty if it is lost.
std::optional<double> withNoise(double distance, int blocks, const UwbRadio& radio,
                                const std::string& anchor, const std::string& tag,
                                const Moment& now) {
    const std::uint64_t pair = hashOf(anchor) ^ mixedBits(hashOf(tag));
    const auto frame = static_cast<std::uint64_t>(now.frame);
    const std::uint64_t seed = *now.options.noise_seed;
    auto range = static_cast<float>(distance);
    double measured = distance;
    if (!radio.noise.isNone()) {
        addNoise(radio.noise, 0, std::numeric_limits<float>::max(),
                 {seed, pair, frame, Purpose::Range}, {}, std::span(&range, 1));
        if (range == kNoReturn) return std::nullopt;
        measured = static_cast<double>(range);
    }
    if (blocks > 0) {
        std::array<float, 1> normal{};
        draw({seed, Purpose::Range, mixedBits(pair), frame}, 0, {.normal = normal});
        measured += blocks * radio.blocked_bias +
                    std::sqrt(blocks) * radio.blocked_sigma * static_cast<double>(normal[0]);
    }
    return std::max(0.0, measured);
}

/// Measures the range of a tag; empty if the anchor does not reach it.
std::optional<Ranging> rangingOf(const UwbRadio& radio, const std::string& anchor, Point3 at,
                                 std::uint32_t carrier, const std::string& tag, Point3 place,
                                 const Moment& now) {
    const double distance = length(place - at);
    if (static_cast<float>(distance) < static_cast<float>(radio.min_range) ||
        !withinRange(distance, radio.max_range))
        return std::nullopt;
    const int blocks = blocksBetween(at, place, carrier, now);
    constexpr double kDecibels = 20;
    if (blocks > 0 &&
        !withinRange(distance, radio.max_range / std::pow(10.0, blocks * radio.loss / kDecibels)))
        return std::nullopt;
    if (!now.options.noise_seed) return Ranging{distance, blocks};
    const auto range = withNoise(distance, blocks, radio, anchor, tag, now);
    return range ? std::optional(Ranging{*range, blocks}) : std::nullopt;
}

/// Estimates the standard deviation of a range in line of sight.
double errorOf(const UwbRadio& radio) { return std::hypot(radio.noise.sigma[0], radio.noise.bias); }

/// An anchor near enough to a tag.
struct NearAnchor {
    double distance = 0;
    std::size_t anchor = 0;  ///< index in Uwb::anchors
};

bool isFarther(const NearAnchor& a, const NearAnchor& b) {
    return std::tie(a.distance, a.anchor) > std::tie(b.distance, b.anchor);
}

const Pose3& anchorPose(const UwbAnchor& anchor, const Moment& now) {
    return anchor.id == now.sensor.id ? now.pose : anchor.pose;
}

/// Returns the anchors whose range contains a tag, as a heap with the nearest on top.
std::vector<NearAnchor> anchorsAbout(Point3 place, const Uwb& uwb, const Moment& now) {
    std::vector<NearAnchor> near;
    std::size_t index = 0;
    for (const UwbAnchor& anchor : uwb.anchors) {
        const double distance = length(place - anchorPose(anchor, now).position);
        if (withinRange(distance, anchor.radio.max_range)) near.push_back({distance, index});
        ++index;
    }
    std::make_heap(near.begin(), near.end(), isFarther);
    return near;
}

/// Decides on the plan whether a tag in line of sight of these anchors can be within a distance of
/// a point: some point so near is indoors and in sight of each anchor, standing things only.
bool canBe(Point3 place, double distance, const std::vector<Hearing>& heard, const Moment& now) {
    const Environment& environment = now.worlds.environment();
    const Point2 on_floor = place.onFloor();
    if (environment.indoorIndex().locate(on_floor) == Side::Outside) {
        bool is_near = false;
        environment.indoor().forEachEdge([&](const Segment2& edge) {
            is_near = is_near || ispace::distance(on_floor, edge) <= distance;
        });
        if (!is_near) return false;
    }
    const std::array<Vec3, 7> ways = {{{0, 0, 0},
                                       {distance, 0, 0},
                                       {-distance, 0, 0},
                                       {0, distance, 0},
                                       {0, -distance, 0},
                                       {0, 0, distance},
                                       {0, 0, -distance}}};
    return std::all_of(heard.begin(), heard.end(), [&](const Hearing& one) {
        return std::any_of(ways.begin(), ways.end(), [&](const Vec3& way) {
            return blocksBetween(one.place, place + way, MovingBodies::kNoOwner, now, false) == 0;
        });
    });
}

/// Locates a tag by the nearest anchors that have it in line of sight.
std::optional<PositionFix> fixOf(const Uwb& uwb, const std::string& tag, Point3 place,
                                 const Moment& now) {
    std::vector<Hearing> heard;
    std::vector<NearAnchor> near = anchorsAbout(place, uwb, now);
    while (!near.empty() && heard.size() < kMaxAnchors) {
        std::pop_heap(near.begin(), near.end(), isFarther);
        const UwbAnchor& anchor = uwb.anchors.begin()[near.back().anchor];
        near.pop_back();
        const Pose3& pose = anchorPose(anchor, now);
        const auto ranging = rangingOf(anchor.radio, anchor.id, pose.position,
                                       MovingBodies::kNoOwner, tag, place, now);
        if (!ranging || ranging->blocks > 0) continue;
        // Of mirror images, the one in front of the anchors or below them.
        const Vec3 ahead = pose.beam({}), axis{ahead.x, ahead.y, ahead.z - 1};
        const double size = length(axis);
        heard.push_back({pose.position, size > 0 ? (1 / size) * axis : axis, Angle::degrees(360),
                         ranging->range, now.options.noise_seed ? errorOf(anchor.radio) : 0});
    }
    const auto admits = [&](Point3 at, double distance) { return canBe(at, distance, heard, now); };
    return locate(heard, {kMinAnchors, 0, now.worlds.environment().height(), admits});
}

}  // namespace

UwbRanges readingOf(const Uwb& uwb, const Moment& now) {
    UwbRanges reading{now.time, now.frame, now.pose, {}};
    for (const RfidTag& tag : uwb.tags) {
        const auto place = placeOf(tag, now);
        if (!place) continue;
        const auto ranging = rangingOf(uwb, now.sensor.id, now.pose.position, carrierOf(now.sensor),
                                       tag.text, *place, now);
        if (!ranging) continue;
        reading.tags.push_back(
            {tag.text, ranging->range, ranging->blocks > 0, fixOf(uwb, tag.text, *place, now)});
    }
    std::sort(reading.tags.begin(), reading.tags.end(), [](const UwbRange& a, const UwbRange& b) {
        return std::tie(a.tag, a.range) < std::tie(b.tag, b.range);
    });
    const auto same = [](const UwbRange& a, const UwbRange& b) { return a.tag == b.tag; };
    reading.tags.erase(std::unique(reading.tags.begin(), reading.tags.end(), same),
                       reading.tags.end());
    return reading;
}

}  // namespace ispace
