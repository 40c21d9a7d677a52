// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/robot_xml.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/number.h"

namespace ispace {

namespace {

/// Rounded to a number of steps a unit; minus zero becomes zero.
std::string rounded(double value, double steps) {
    return formatDouble(std::round(value * steps) / steps + 0.0);
}

constexpr double kLengthSteps = 1e9, kAngleSteps = 1e12;

}  // namespace

std::string XmlNames::take(std::string_view id) {
    std::string name(id);
    for (std::size_t at = 0; (at = name.find("::", at)) != std::string::npos;)
        name.replace(at, 2, "-");
    if (name.starts_with("__")) name.insert(0, "id");
    if (name.ends_with("__")) name += "id";
    std::string free = name;
    for (int i = 2; !taken_.insert(free).second; ++i) free = name + '-' + std::to_string(i);
    return free;
}

std::string lengthsText(std::initializer_list<double> metres) {
    std::string text;
    for (const double length : metres) {
        if (!text.empty()) text += ' ';
        text += rounded(length, kLengthSteps);
    }
    return text;
}

std::string radiansText(Angle angle) { return rounded(angle.radians(), kAngleSteps); }

std::string anglesText(const Pose3& pose) {
    return radiansText(wrapped(pose.roll)) + ' ' + radiansText(wrapped(-pose.tilt)) + ' ' +
           radiansText(wrapped(pose.heading));
}

pugi::xml_node addText(pugi::xml_node parent, const char* name, const std::string& text) {
    pugi::xml_node node = parent.append_child(name);
    node.append_child(pugi::node_pcdata).set_value(text.c_str());
    return node;
}

std::string xmlText(const pugi::xml_document& document) {
    std::ostringstream text;
    document.save(text, "  ", pugi::format_indent, pugi::encoding_utf8);
    return std::move(text).str();
}

MeshBox boxAround(const std::vector<Mesh>& meshes) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Point3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (const Mesh& mesh : meshes)
        for (const Point3& p : mesh.vertices) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    return {low + 0.5 * (high - low), {high.x - low.x, high.y - low.y, high.z - low.z}};
}

}  // namespace ispace
