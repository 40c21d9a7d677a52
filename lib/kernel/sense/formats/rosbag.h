// SPDX-License-Identifier: GPL-3.0-or-later
// Makes an MCAP file a bag of rosbag2, the recorder of ROS 2: channels with qualities of service,
// and the metadata beside the file. Pure functions; the format is that of rosbag2's version 5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "sense/formats/mcap_writer.h"

namespace ispace {

/// Quality of service with which a topic of a recording was offered.
struct BagQuality {
    std::size_t depth = 10;
    bool is_latched = false;  ///< transient_local: later readers get the last message
};

/// Returns a channel of rosbag2's storage: `ros2 bag play` offers its topic with this quality,
/// reliably. Without it readers of latched topics, as of /tf_static and /map, would hear no
/// message.
McapChannel bagChannel(std::uint16_t schema, std::string topic, const BagQuality& quality);

/// Returns the text of `metadata.yaml`, which stands beside the only file of a bag (rosbag2,
/// version 5), so that `ros2 bag info` and `play` take the folder. \param file name of the MCAP
/// file, relative to the folder
std::string bagMetadata(const McapContent& content, const std::string& file);

}  // namespace ispace
