// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/unit.h"

#include <numbers>

namespace ispace {

namespace {

constexpr UnitSuffix kLength[] = {{"m"}, {"km", 3}, {"cm", -2}, {"mm", -3}};
constexpr UnitSuffix kAngle[] = {{"deg"}, {"rad", 0, 180 / std::numbers::pi}};
constexpr UnitSuffix kArea[] = {{"m2"}};
constexpr UnitSuffix kTime[] = {{"s"},      {"ms", -3},    {"us", -6},
                                {"ns", -9}, {"min", 1, 6}, {"h", 2, 36}};
constexpr UnitSuffix kFrequency[] = {{"Hz"}};

}  // namespace

std::span<const UnitSuffix> suffixesOf(Unit unit) {
    switch (unit) {
        case Unit::Length:
            return kLength;
        case Unit::Angle:
            return kAngle;
        case Unit::Area:
            return kArea;
        case Unit::Time:
            return kTime;
        case Unit::Frequency:
            return kFrequency;
        case Unit::None:
        case Unit::Share:
            break;
    }
    return {};
}

std::string suffixNames(Unit unit) {
    const auto suffixes = suffixesOf(unit);
    std::string names;
    for (std::size_t i = 0; i < suffixes.size(); ++i) {
        if (i > 0) names += i + 1 == suffixes.size() ? " or " : ", ";
        names += suffixes[i].name;
    }
    return names;
}

}  // namespace ispace
