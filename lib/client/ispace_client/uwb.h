// SPDX-License-Identifier: GPL-3.0-or-later
// Ultra-wideband anchors: ranges of tags, and the positions that all anchors find together. Metres.
//
//     for (const TagRange& one : Uwb("127.0.0.1:7001", "anchor1").scan().tags)
//         if (one.is_located) draw(one.tag, one.x, one.y);
#ifndef ISPACE_CLIENT_UWB_H
#define ISPACE_CLIENT_UWB_H

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <ispace_client/error.h>
#include <ispace_client/sensor.h>

namespace ispace {
namespace client {

/// The range of a tag, and its position by all anchors.
struct TagRange {
    std::string tag;
    double range = 0;         ///< m
    bool is_blocked = false;  ///< a wall or a mover is between
    bool is_located = false;
    bool is_ambiguous = false;  ///< its position is one of two, mirror images
    double x = std::numeric_limits<double>::quiet_NaN();  ///< m; NaN: not located
    double y = std::numeric_limits<double>::quiet_NaN();
    double z = std::numeric_limits<double>::quiet_NaN();
};

/// The tags that an anchor reaches.
struct TagRanges : Reading {
    std::vector<TagRange> tags;  ///< sorted

    static TagRanges from(const Message& message) {
        TagRanges reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        const Fields& fields = reading.fields;
        const std::size_t count = static_cast<std::size_t>(fields.integer("n"));
        const std::vector<std::string> tags = fields.list("tags"), x = fields.list("x"),
                                       y = fields.list("y"), z = fields.list("z");
        const std::vector<double> ranges = fields.numbers("ranges"),
                                  blocked = fields.numbers("blocked");
        const std::vector<std::string> ambiguous = fields.list("ambiguous");
        for (const std::size_t size : {tags.size(), ranges.size(), blocked.size(), x.size(),
                                       y.size(), z.size(), ambiguous.size()})
            if (size != count)
                throw ProtocolError("a reading of " + reading.sensor + " is incomplete");
        for (std::size_t i = 0; i < count; ++i) {
            TagRange one;
            one.tag = tags[i];
            one.range = ranges[i];
            one.is_blocked = blocked[i] != 0;
            one.is_located = x[i] != "-";
            if (one.is_located) {
                one.x = numberOf(x[i]);
                one.y = numberOf(y[i]);
                one.z = numberOf(z[i]);
                one.is_ambiguous = ambiguous[i] == "1";
            }
            reading.tags.push_back(one);
        }
        return reading;
    }
};

using Uwb = SensorOf<TagRanges>;

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_UWB_H
