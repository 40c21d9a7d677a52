// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ispace {

/// What a number in a file or an option measures. It may carry a suffix; without one it is in the
/// first unit named.
enum class Unit {
    None,
    Length,     ///< m; also km, cm, mm
    Angle,      ///< deg; also rad
    Area,       ///< m2
    Time,       ///< s; also ms, us, ns, min, h
    Frequency,  ///< Hz
    Share,      ///< fraction 0..1; text "95%" or "0.95", a bare number above 1 is refused
};

/// A unit is `factor` times 10^exponent of the first: "30.1cm" is scaled by the exponent before it
/// is rounded to a double.
struct UnitSuffix {
    std::string_view name;
    int exponent = 0;
    double factor = 1;  ///< whole for all but angles
};

/// The first has neither exponent nor factor; empty for None and Share.
std::span<const UnitSuffix> suffixesOf(Unit unit);

/// "m, km, cm or mm"
std::string suffixNames(Unit unit);

}  // namespace ispace
