// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel densities by their names in two editions of a standard. Constant tables, thread-safe.
//
//     const auto found = findClass("recognize");
//     const double density = densityClasses()[found->index].pixels_per_metre;  // 125
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ispace {

enum class DensityStandard {
    Classes2015,  ///< EN 62676-4:2015: monitor to inspect
    Levels2025,   ///< IEC 62676-4:2025: overview to scrutinise
};

/// Returns "EN 62676-4:2015" or "IEC 62676-4:2025".
std::string_view nameOf(DensityStandard standard);

/// A density that one standard names, or both.
struct DensityClass {
    double pixels_per_metre = 0;
    std::string_view name;        ///< of 2015, else of 2025
    std::string_view level = {};  ///< of 2025; "" if that has no such density
};

/// Returns the classes of 2015, in the order of pixelDensities(), then the levels of 2025 that have
/// other densities.
std::span<const DensityClass> densityClasses();

/// Returns the indices in densityClasses() of a standard's names, the coarsest first.
std::span<const std::size_t> classesOf(DensityStandard standard);
/// Returns the indices of all densityClasses(), the coarsest first.
std::span<const std::size_t> classesByDensity();

/// Returns the name in a standard, or in the other one if only that has this density.
std::string_view className(std::size_t index, DensityStandard standard);
/// Returns both names: "identify / characterise", "overview".
std::string classNames(std::size_t index);

/// A class by one of its names.
struct FoundClass {
    std::size_t index = 0;  ///< in densityClasses()
    DensityStandard standard = DensityStandard::Classes2015;
};
/// Finds a class by its name in either spelling of `recognise`, `characterise` and `scrutinise`.
std::optional<FoundClass> findClass(std::string_view name);

}  // namespace ispace
