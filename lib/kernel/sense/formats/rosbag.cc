// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/rosbag.h"

#include <utility>

#include "base/json_writer.h"

namespace ispace {

namespace {

/// A profile as rosbag2 writes it, an element of a list. Names of policies are the numbers of rmw.
std::string qualityText(const BagQuality& quality) {
    constexpr const char* kForever = "    sec: 9223372036\n    nsec: 854775807\n";
    const std::string durability = quality.is_latched ? "1" : "2";
    return "- history: 1\n  depth: " + std::to_string(quality.depth) +
           "\n  reliability: 1\n  durability: " + durability + "\n  deadline:\n" + kForever +
           "  lifespan:\n" + kForever + "  liveliness: 1\n  liveliness_lease_duration:\n" +
           kForever + "  avoid_ros_namespace_conventions: false\n";
}

/// Quotes a text for YAML, of which JSON's strings are a part.
std::string quoted(const std::string& text) { return JsonWriter().value(text).take(); }

}  // namespace

McapChannel bagChannel(std::uint16_t schema, std::string topic, const BagQuality& quality) {
    return {schema, std::move(topic), {{"offered_qos_profiles", qualityText(quality)}}};
}

std::string bagMetadata(const McapContent& content, const std::string& file) {
    const std::string start = "nanoseconds_since_epoch: " + std::to_string(content.first),
                      duration = "nanoseconds: " + std::to_string(content.last - content.first),
                      count = "message_count: " + std::to_string(content.messages);
    std::string text =
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n  duration:\n   "
        " " +
        duration + "\n  starting_time:\n    " + start + "\n  " + count +
        "\n  topics_with_message_count:\n";
    for (const McapCount& one : content.channels) {
        const auto quality = one.channel.metadata.find("offered_qos_profiles");
        text += "    - topic_metadata:\n        name: " + quoted(one.channel.topic) +
                "\n        type: " + one.type +
                "\n        serialization_format: cdr\n        offered_qos_profiles: " +
                quoted(quality == one.channel.metadata.end() ? "" : quality->second) +
                "\n      message_count: " + std::to_string(one.messages) + '\n';
    }
    return text +
           "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " +
           quoted(file) + "\n  files:\n    - path: " + quoted(file) +
           "\n      starting_time:\n        " + start + "\n      duration:\n        " + duration +
           "\n      " + count + '\n';
}

}  // namespace ispace
