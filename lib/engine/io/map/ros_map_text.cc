// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/map/ros_map_text.h"

#include <algorithm>

#include "base/json_writer.h"
#include "base/number.h"

namespace ispace {

namespace {

/// Quotes names that YAML would not read as text; JSON strings are YAML strings.
std::string yamlText(const std::string& text) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '.' || c == '/' || c == '-';
    };
    const bool begins_as_word =
        !text.empty() && text.front() != '-' &&
        (is_plain(text.front()) && !(text.front() >= '0' && text.front() <= '9'));
    if (begins_as_word && text.find('.') != std::string::npos &&
        std::all_of(text.begin(), text.end(), is_plain))
        return text;
    JsonWriter json;
    json.value(text);
    return json.take();
}

}  // namespace

std::string yamlDouble(double value) {
    const std::string text = formatDouble(value);
    return text.find('.') == std::string::npos ? text + ".0" : text;
}

std::string rosMapYaml(const RosMap& map) {
    return "image: " + yamlText(map.image) + "\nmode: " + std::string(map.mode) +
           "\nresolution: " + formatDouble(map.resolution) + "\norigin: [" +
           formatDouble(map.origin.x) + ", " + formatDouble(map.origin.y) +
           ", 0]\nnegate: 0\noccupied_thresh: " + yamlDouble(map.occupied) +
           "\nfree_thresh: " + yamlDouble(map.free) + '\n';
}

}  // namespace ispace
