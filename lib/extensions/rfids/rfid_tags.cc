// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/rfids/rfid_tags.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "sense/electronic_tag_place.h"
#include "sense/sighting.h"

namespace ispace::rfids {

namespace {

/// Returns true if a tag that stands still is in the field, and the way to it is free.
bool isInField(Point3 tag, const Observer& observer, const Moment& now) {
    const Point3 antenna = now.pose.position;
    const double distance = length(tag - antenna);
    if (distance < observer.min_range || !observer.view.holds(tag)) return false;
    if (distance == 0) return true;
    std::uint8_t is_free = 0;
    now.mesh().query(antenna, std::span(&tag, 1), std::span(&is_free, 1));
    return is_free != 0 && !now.bodies.between(antenna, tag, observer.carrier);
}

bool isRead(const std::string& tag, double share, const Moment& now) {
    if (!now.options.noise_seed || share >= 1) return true;
    std::array<float, 1> uniform{};
    draw(now.noiseKey(hashOf(tag)), 0, {.uniform = uniform});
    return static_cast<double>(uniform[0]) < share;
}

/// Returns whether a tag is read where its mover is seen.
bool isWorn(const ElectronicTag& tag) {
    return tag.carrier != ElectronicTag::Carrier::Thing && !tag.is_in_hand;
}

}  // namespace

RfidTags readingOf(const Rfid& rfid, const Moment& now) {
    RfidTags reading;
    const Observer observer{fieldOfView(rfid, now.pose), rfid.min_range, carrierOf(now.sensor)};
    std::vector<std::uint32_t> owners;
    for (const ElectronicTag& tag : rfid.tags)
        if (isWorn(tag)) owners.push_back(ownerOf(tag));
    std::sort(owners.begin(), owners.end());
    std::vector<std::uint32_t> seen;
    if (!owners.empty())
        for (const Sighting& sighting :
             sightingsOf(observer, now.mesh(), now.bodies, [&owners](std::uint32_t owner) {
                 return std::binary_search(owners.begin(), owners.end(), owner);
             }))
            seen.push_back(sighting.body->owner);
    std::sort(seen.begin(), seen.end());
    for (const ElectronicTag& tag : rfid.tags) {
        const std::optional<Point3> place =
            tag.is_in_hand ? placeInHand(tag, now.bodies) : std::optional(tag.at);
        const bool is_in_field = isWorn(tag)
                                     ? std::binary_search(seen.begin(), seen.end(), ownerOf(tag))
                                     : place && isInField(*place, observer, now);
        if (is_in_field && isRead(tag.text, rfid.read, now)) reading.tags.push_back(tag.text);
    }
    std::sort(reading.tags.begin(), reading.tags.end());
    reading.tags.erase(std::unique(reading.tags.begin(), reading.tags.end()), reading.tags.end());
    return reading;
}

}  // namespace ispace::rfids
