// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/uwbs/uwb_ranges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "env/point_location.h"
#include "geom/predicates.h"
#include "sense/electronic_tag_place.h"
#include "sense/noise.h"
#include "sense/shared_results.h"
#include "sense/walls_between.h"

namespace ispace::uwbs {

namespace {

constexpr double kOffBody = 0.02;  // metres between a tag and the body that carries it
constexpr double kChest = 0.75;    // height of a person's tag, as a share of the trunk

/// Returns the position of a tag on the body of its carrier.
Point3 tagOn(const MovingBody& body, bool is_person) {
    Point2 local;
    double height = body.top + kOffBody;
    if (is_person && body.half_length > body.top - body.bottom) {
        // It lies, with its head ahead.
        local.x = (2 * kChest - 1) * body.half_length;
        if (body.faces_down) height = body.bottom + kOffBody;
    } else if (is_person) {
        local.x = body.half_length + kOffBody;
        height = body.bottom + kChest * (body.top - body.bottom);
    }
    const Point2 at = body.pose * local;
    return {at.x, at.y, height};
}

/// Returns the positions of tags; empty for those of movers without a body. O(tags + bodies)
std::vector<std::optional<Point3>> placesOf(const SharedList<ElectronicTag>& tags,
                                            const MovingBodies& bodies) {
    const auto is_person = [](std::uint32_t owner) { return owner >= kFirstPerson; };
    std::unordered_map<std::uint32_t, const MovingBody*> carriers;
    for (const MovingBody& body : bodies.bodies())
        // The trunk is a person's first box.
        if (!is_person(body.owner) || body.radius == 0) carriers.emplace(body.owner, &body);
    std::vector<std::optional<Point3>> places;
    places.reserve(tags.size());
    for (const ElectronicTag& tag : tags) {
        if (tag.carrier == ElectronicTag::Carrier::Thing) {
            places.emplace_back(tag.at);
            continue;
        }
        if (tag.is_in_hand) {
            places.push_back(placeInHand(tag, bodies));
            continue;
        }
        const auto mover = static_cast<std::uint32_t>(tag.mover);
        const bool on_person = tag.carrier == ElectronicTag::Carrier::Person;
        const auto carrier = carriers.find(on_person ? kFirstPerson + mover : mover);
        places.push_back(carrier == carriers.end()
                             ? std::nullopt
                             : std::optional(tagOn(*carrier->second, on_person)));
    }
    return places;
}

/// Counts the walls between two points, and all movers as one. \param is_free whether no wall is
/// between, if known
int blocksBetween(Point3 from, Point3 to, std::uint32_t carrier, const Moment& now,
                  bool with_movers = true, std::optional<bool> is_free = {}) {
    if (from == to) return 0;
    if (!is_free) {
        std::uint8_t free = 0;
        now.mesh().query(from, std::span(&to, 1), std::span(&free, 1));
        is_free = free != 0;
    }
    // A surface that ends touch is none between.
    const int walls = *is_free ? 0 : std::max(1, wallsBetween(from, to, now.mesh()));
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

/// Measures the range of a tag; empty if the anchor does not reach it. \param is_free as of
/// blocksBetween()
std::optional<Ranging> rangingOf(const UwbRadio& radio, const std::string& anchor, Point3 at,
                                 std::uint32_t carrier, const std::string& tag, Point3 place,
                                 const Moment& now, std::optional<bool> is_free = {}) {
    const double distance = length(place - at);
    if (static_cast<float>(distance) < static_cast<float>(radio.min_range) ||
        !withinRange(distance, radio.max_range))
        return std::nullopt;
    const int blocks = blocksBetween(at, place, carrier, now, true, is_free);
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

/// An anchor near enough to a tag, or a tag near enough to an anchor.
struct Near {
    double distance = 0;
    std::size_t index = 0;  ///< in Uwb::anchors, or in Uwb::tags
};

bool isFarther(const Near& a, const Near& b) {
    return std::tie(a.distance, a.index) > std::tie(b.distance, b.index);
}

/// Takes the nearest from a heap. \pre it is not empty
Near takeNearest(std::vector<Near>& heap) {
    std::pop_heap(heap.begin(), heap.end(), isFarther);
    const Near nearest = heap.back();
    heap.pop_back();
    return nearest;
}

const Pose3& anchorPose(const UwbAnchor& anchor, const Moment& now) {
    return anchor.id == now.sensor.idInRoom() ? now.pose : anchor.pose;
}

/// Returns the anchors whose range contains a tag, as a heap with the nearest on top.
std::vector<Near> anchorsAbout(Point3 place, const Uwb& uwb, const Moment& now) {
    std::vector<Near> near;
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
    std::vector<Near> near = anchorsAbout(place, uwb, now);
    while (!near.empty() && heard.size() < kMaxAnchors) {
        const UwbAnchor& anchor = uwb.anchors.begin()[takeNearest(near).index];
        const Pose3& pose = anchorPose(anchor, now);
        const auto ranging = rangingOf(anchor.radio, now.sensor.idBeside(anchor.id), pose.position,
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

bool UwbFixes::Known::isOf(const Uwb& uwb, const Moment& now) const {
    return frame == now.frame && time == now.time && seed == now.options.noise_seed &&
           worlds == &now.worlds &&
           &environment.elements() == &now.worlds.environment().elements() && tags == uwb.tags &&
           anchors == uwb.anchors && std::ranges::equal(bodies, now.bodies.bodies());
}

std::shared_ptr<UwbFixes::Tags> UwbFixes::at(const Uwb& uwb, const Moment& now) {
    // Sensors of two rates, and the threads that read a batch, are at some moments at once.
    constexpr std::size_t kMost = 8;
    const auto tags_of = [&] {
        auto tags = std::make_shared<Tags>();
        tags->places = placesOf(uwb.tags, now.bodies);
        tags->fixes.resize(uwb.tags.size());
        return tags;
    };
    const bool is_moved =
        std::any_of(uwb.anchors.begin(), uwb.anchors.end(), [&](const UwbAnchor& anchor) {
            return anchor.id == now.sensor.idInRoom() && anchor.pose != now.pose;
        });
    if (is_moved) return tags_of();
    const std::lock_guard lock(mutex_);
    for (const Known& known : known_)
        if (known.isOf(uwb, now)) return known.of;
    const std::span<const MovingBody> bodies = now.bodies.bodies();
    known_.push_front({now.frame,
                       now.time,
                       now.options.noise_seed,
                       &now.worlds,
                       now.worlds.environment(),
                       uwb.tags,
                       uwb.anchors,
                       {bodies.begin(), bodies.end()},
                       tags_of()});
    if (known_.size() > kMost) known_.pop_back();
    return known_.front().of;
}

namespace {

/// Returns the tags at a distance that an anchor can measure, as a heap with the nearest on top.
std::vector<Near> tagsAbout(const Uwb& uwb, Point3 at,
                            const std::vector<std::optional<Point3>>& places) {
    std::vector<Near> near;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!places[i]) continue;
        const double distance = length(*places[i] - at);
        if (withinRange(distance, uwb.max_range)) near.push_back({distance, i});
    }
    std::make_heap(near.begin(), near.end(), isFarther);
    return near;
}

/// Finds which of some tags no wall hides from an anchor, by rays side by side.
std::vector<std::uint8_t> areInSight(std::span<const Near> tags, Point3 at,
                                     const std::vector<std::optional<Point3>>& places,
                                     const Moment& now) {
    std::vector<Point3> points;
    points.reserve(tags.size());
    for (const Near& tag : tags) points.push_back(*places[tag.index]);
    std::vector<std::uint8_t> free(points.size());
    now.mesh().query(at, points, free);
    return free;
}

}  // namespace

UwbRanges readingOf(const Uwb& uwb, const Moment& now) {
    UwbRanges reading;
    UwbFixes own;
    UwbFixes& fixes = now.options.shared ? now.options.shared->of<UwbFixes>() : own;
    const std::shared_ptr<UwbFixes::Tags> tags = fixes.at(uwb, now);
    const auto fix_of = [&](std::size_t i, const std::string& tag, Point3 place) {
        {
            const std::lock_guard lock(tags->mutex);
            if (tags->fixes[i]) return *tags->fixes[i];
        }
        const std::optional<PositionFix> fix = fixOf(uwb, tag, place, now);
        const std::lock_guard lock(tags->mutex);
        tags->fixes[i] = fix;
        return fix;
    };
    const auto take = [&](std::size_t i, bool is_in_sight) {
        const ElectronicTag& tag = uwb.tags.begin()[i];
        const Point3 place = *tags->places[i];
        const auto ranging = rangingOf(uwb, now.sensor.id, now.pose.position, carrierOf(now.sensor),
                                       tag.text, place, now, is_in_sight);
        if (ranging)
            reading.tags.push_back(
                {tag.text, ranging->range, ranging->blocks > 0, fix_of(i, tag.text, place)});
    };
    std::vector<Near> near = tagsAbout(uwb, now.pose.position, tags->places);
    while (!near.empty() && reading.tags.size() < uwb.slots) {
        std::vector<Near> asked;
        while (!near.empty() && reading.tags.size() + asked.size() < uwb.slots)
            asked.push_back(takeNearest(near));
        const std::vector<std::uint8_t> free =
            areInSight(asked, now.pose.position, tags->places, now);
        for (std::size_t k = 0; k < asked.size(); ++k) take(asked[k].index, free[k] != 0);
    }
    std::sort(reading.tags.begin(), reading.tags.end(), [](const UwbRange& a, const UwbRange& b) {
        return std::tie(a.tag, a.range) < std::tie(b.tag, b.range);
    });
    const auto same = [](const UwbRange& a, const UwbRange& b) { return a.tag == b.tag; };
    reading.tags.erase(std::unique(reading.tags.begin(), reading.tags.end(), same),
                       reading.tags.end());
    return reading;
}

}  // namespace ispace::uwbs
