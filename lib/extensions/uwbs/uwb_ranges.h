// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of ultra-wideband anchors: two-way ranging as in IEEE 802.15.4, by its results, and
// positions by multilateration (sense/locate.h).
//
//     const UwbRanges reading = readingOf(sensor.as<Uwb>(), moment);
//     for (const UwbRange& one : reading.tags)
//         if (one.fix) show(one.tag, one.fix->position);  // three anchors have it in sight
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "extensions/uwbs/uwb.h"
#include "sense/added_reading.h"
#include "sense/locate.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::uwbs {

/// Anchors that locate a tag at most: the nearest in line of sight.
constexpr std::size_t kMaxAnchors = 16;

/// The range of one tag, and the position of the tag by all anchors of the room.
struct UwbRange {
    std::string tag;
    double range = 0;         ///< metres
    bool is_blocked = false;  ///< a wall or a mover is between
    std::optional<PositionFix> fix = {};
};

/// One round of ranges of an anchor.
struct UwbRanges {
    std::vector<UwbRange> tags;  ///< sorted, each once: the nearest of those of one text

    static const ReadingKind kKind;
};

/// The positions of tags at the last few moments, each of which the anchors of a room compute once
/// for all. Thread-safe.
class UwbFixes {
  public:
    /// Of one moment: by the index of a tag in Uwb::tags.
    struct Tags {
        std::vector<std::optional<Point3>> places;  ///< empty without a body that carries it
        std::mutex mutex;                           ///< guards `fixes`
        std::vector<std::optional<std::optional<PositionFix>>> fixes;  ///< computed so far
    };
    /// Returns the tags of a moment, the same ones for equal anchors, tags, time and bodies. An
    /// anchor that is away from its pose in Uwb::anchors has tags alone.
    std::shared_ptr<Tags> at(const Uwb& uwb, const Moment& now);

  private:
    /// All that positions depend on.
    struct Known {
        int frame;
        double time;
        std::optional<std::uint64_t> seed;
        const RayScenes* worlds;
        Environment environment;  // keeps the address of its elements
        SharedList<ElectronicTag> tags;
        SharedList<UwbAnchor> anchors;
        std::vector<MovingBody> bodies;
        std::shared_ptr<Tags> of;

        [[nodiscard]] bool isOf(const Uwb& uwb, const Moment& now) const;
    };
    std::mutex mutex_;
    std::deque<Known> known_;  // the latest first
};

/// Measures the ranges of the tags that an anchor reaches, of more than Uwb::slots the nearest. The
/// tag of a thing lies above the middle of its top, in a hand as well, that of a robot too; a
/// person wears it on the chest, and is a mover between for anchors behind. Each wall (see
/// wallsBetween(), sense/walls_between.h) or mover between divides the greatest range by
/// 10^(loss/20), and with noise adds to the error; all movers count once.
///
/// The position comes from the anchors that stand in the room and have the tag in line of sight, at
/// least kMinAnchors and of more than kMaxAnchors the nearest, by locate() within the height of the
/// room. Of two candidates (mirror images), one outside of the indoor region or hidden from an
/// anchor is rejected; if both are possible, the one below or in front of the anchors is taken, and
/// PositionFix::is_one_of_two is set.
///
/// Noise depends on seed, anchor, tag and frame alone: anchors of one rate compute one position,
/// and only once with TakerOptions::shared: at most O(slots) rays an anchor, and
/// O(tags * anchors) distances a moment.
UwbRanges readingOf(const Uwb& uwb, const Moment& now);

}  // namespace ispace::uwbs
