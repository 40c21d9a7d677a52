// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <numbers>

namespace ispace {

/// A plane angle; the unit is named where one is made or read. Counter-clockwise is positive.
///
/// Kept in degrees, the unit of files and options, so that 90 is exactly a quarter turn:
/// cosine and sine are exact at multiples of 90 degrees and walls drawn square stay square.
class Angle {
  public:
    constexpr Angle() = default;
    static constexpr Angle degrees(double value) { return Angle(value); }
    static constexpr Angle radians(double value) { return Angle(value * (180 / std::numbers::pi)); }
    [[nodiscard]] constexpr double degrees() const { return degrees_; }
    [[nodiscard]] constexpr double radians() const { return degrees_ * (std::numbers::pi / 180); }

    friend constexpr Angle operator+(Angle a, Angle b) { return Angle(a.degrees_ + b.degrees_); }
    friend constexpr Angle operator-(Angle a, Angle b) { return Angle(a.degrees_ - b.degrees_); }
    friend constexpr Angle operator-(Angle a) { return Angle(-a.degrees_); }
    friend constexpr Angle operator*(double s, Angle a) { return Angle(s * a.degrees_); }
    friend constexpr auto operator<=>(Angle a, Angle b) = default;

  private:
    explicit constexpr Angle(double degrees) : degrees_(degrees) {}
    double degrees_ = 0;
};

struct CosSin {
    double cos, sin;
};
/// Both at once; exact at multiples of 90 degrees.
CosSin cosSin(Angle angle);
double cos(Angle angle);
double sin(Angle angle);
double tan(Angle angle);

/// The same direction within (-180, 180] degrees.
Angle wrapped(Angle angle);

/// Direction of the vector (x, y), in (-180, 180]; 0 for the null vector.
Angle directionOf(double x, double y);

}  // namespace ispace
