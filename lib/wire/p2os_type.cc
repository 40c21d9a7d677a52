// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire/p2os_type.h"

#include <algorithm>
#include <array>

namespace ispace {

namespace {

constexpr std::array<P2osType, 5> kTypes = {{
    {"p3dx-sh", 1, 1, 0.0056, 2200, 500, 21, 0},
    {"p3dx", 0.485, 1, 0.0056, 2200, 500, 18, 0},
    {"p2dx", 0.84, 0.268, 0.0056, 2200, 500, 17, 8},
    {"p3at-sh", 1, 1, 0.0034, 1200, 300, 125, 0},
    {"p3at", 0.465, 1, 0.0034, 1200, 300, 160, 0},
}};

}  // namespace

std::span<const P2osType> p2osTypes() { return kTypes; }

const P2osType* p2osTypeNamed(std::string_view name) {
    const auto* const found = std::find_if(
        kTypes.begin(), kTypes.end(), [name](const P2osType& type) { return type.name == name; });
    return found == kTypes.end() ? nullptr : found;
}

const P2osType& p2osTypeOf(const Scene& scene, std::string_view robot) {
    const auto index = static_cast<std::size_t>(
        std::find(scene.ids.begin(), scene.ids.end(), robot) - scene.ids.begin());
    const Record& record = scene.records[index];
    if (record.has("p2os")) return *p2osTypeNamed(record.text("p2os"));
    const std::string model = record.has("model") ? record.text("model") : "";
    if (model == "pioneer-2dx") return *p2osTypeNamed("p2dx");
    if (model == "pioneer-3at" || model == "pioneer-2at") return *p2osTypeNamed("p3at-sh");
    return kTypes.front();
}

}  // namespace ispace
