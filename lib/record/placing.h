// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

/// a + b + c in decimal arithmetic: 0.1 + 0.2 is 0.3. A sum within rounding errors (a picometre for
/// terms of up to a kilometre, more for larger ones) of a number with at most nine decimals is that
/// number. Never minus zero.
double decimalSum(double a, double b, double c = 0);

/// A turned heading: the decimalSum of both in (-180, 180], in degrees.
double turnedHeading(double degrees, Angle turn);

/// Puts a record that stands in a frame into the frame's parent, by the roles of its keys.
///
/// Places that are written move: tuples and lists of them. If none is written, the one that has a
/// default (`at`, 0,0) moves from there and becomes written; without a default, as for a sensor
/// still to be placed or a door placed by its wall, the record stays. A heading turns, and becomes
/// written where it has a default, if `at` moved: that of a wall by its ends says nothing. Courses
/// move always. What has a carrier stays: its places are in the carrier's frame.
///
/// `dz` is added to the third number of places that have one; two numbers become three where the
/// key allows three and dz is not 0 (from KeySpec::standard_z). Other places stay on the floor, see
/// canRise.
///
/// Numbers stay as a person would write them. A coordinate that nothing is added to, turned by
/// multiples of 90 degrees, is exact. Any other is a decimalSum: 1.2 + 0.5 is 1.7, and a move there
/// and back changes nothing. A heading that turns becomes its turnedHeading. \throws FormatError
/// with the record's place if a number leaves its bounds; the record may be
///         moved in part then
void placeIn(Record& record, const Pose2& parent_from_record, double dz = 0);

/// The same for a move within the frame the record's places are in: that of the carrier, if it has
/// one. A carried record without place stands at 0,0.
void moveInFrame(Record& record, const Pose2& motion, double dz = 0);

/// Where the record stands, in the frame of its places: `at`, else the first point of the first
/// place that is written, else the default of `at` (for carried records 0,0); nothing if it has no
/// place.
std::optional<Point2> placeOf(const Record& record);

/// False if placeIn and moveInFrame can move the record but not lift it.
bool canRise(const Record& record);

/// The motion that turns about a point and then moves by an offset.
Pose2 turnAbout(Point2 centre, Angle turn, Vec2 offset);

}  // namespace ispace
