// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of MCAP files (mcap.dev, specification 1), for logs of real rooms and for tracks. Chunks
// are unpacked one at a time, with bounds on their size; a message's bytes are valid during the
// call.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace ispace::reality {

/// A message of an MCAP file, in CDR.
struct McapMessage {
    std::string_view topic;
    std::string_view type;   ///< "sensor_msgs/msg/LaserScan"; "" for other encodings than CDR
    std::uint64_t time = 0;  ///< when it was recorded, nanoseconds
    std::string_view bytes;
    const std::string& place;  ///< in the file, for errors: "byte 4711"
};
using McapUse = std::function<void(const McapMessage& message)>;

/// Returns true if these bytes begin an MCAP file.
bool isMcap(std::string_view bytes);

/// Calls `use` for each message of an MCAP file, in its order; chunks may be packed by zstd or lz4.
/// A FormatError of `use` without a file gets that of the message. \throws FormatError with the
/// byte
void readMcap(std::string_view bytes, const std::string& name, const McapUse& use);

}  // namespace ispace::reality
