// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/density_classes.h"

#include <algorithm>
#include <vector>

#include "scene/sensor/camera.h"

namespace ispace {

namespace {

/// Both standards, joined.
struct ClassTable {
    std::vector<DensityClass> classes;
    std::vector<std::size_t> tasks, levels, sorted;

    ClassTable() {
        for (const PixelDensity& one : pixelDensities()) {
            tasks.push_back(classes.size());
            classes.push_back({one.pixels_per_metre, one.name});
        }
        for (const PixelDensity& one : pixelLevels()) {
            const auto same = std::find_if(classes.begin(), classes.end(), [&](const auto& known) {
                return known.pixels_per_metre == one.pixels_per_metre;
            });
            levels.push_back(static_cast<std::size_t>(same - classes.begin()));
            if (same == classes.end())
                classes.push_back({one.pixels_per_metre, one.name, one.name});
            else
                same->level = one.name;
        }
        for (std::size_t i = 0; i < classes.size(); ++i) sorted.push_back(i);
        std::sort(sorted.begin(), sorted.end(), [this](std::size_t a, std::size_t b) {
            return classes[a].pixels_per_metre < classes[b].pixels_per_metre;
        });
    }
};

const ClassTable& classTable() {
    static const ClassTable table;
    return table;
}

}  // namespace

std::string_view nameOf(DensityStandard standard) {
    return standard == DensityStandard::Classes2015 ? "EN 62676-4:2015" : "IEC 62676-4:2025";
}

std::span<const DensityClass> densityClasses() { return classTable().classes; }

std::span<const std::size_t> classesOf(DensityStandard standard) {
    return standard == DensityStandard::Classes2015 ? classTable().tasks : classTable().levels;
}

std::span<const std::size_t> classesByDensity() { return classTable().sorted; }

std::string_view className(std::size_t index, DensityStandard standard) {
    const DensityClass& one = densityClasses()[index];
    const bool by_level = standard == DensityStandard::Levels2025 && !one.level.empty();
    return by_level ? one.level : one.name;
}

std::string classNames(std::size_t index) {
    const DensityClass& one = densityClasses()[index];
    std::string text(one.name);
    if (!one.level.empty() && one.level != one.name) text.append(" / ").append(one.level);
    return text;
}

std::optional<FoundClass> findClass(std::string_view name) {
    const std::string wanted = name.ends_with("ize")
                                   ? std::string(name.substr(0, name.size() - 3)) + "ise"
                                   : std::string(name);
    for (const auto standard : {DensityStandard::Classes2015, DensityStandard::Levels2025})
        for (const std::size_t index : classesOf(standard))
            if (className(index, standard) == wanted) return FoundClass{index, standard};
    return std::nullopt;
}

}  // namespace ispace
