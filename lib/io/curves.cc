// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/curves.h"

#include <algorithm>
#include <numbers>

#include "geom/predicates.h"

namespace ispace {

namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

/// Least and largest number of pieces in a full circle; the latter for 10 km.
constexpr double kFewestPieces = 8, kMostPieces = 7200;

/// Share of the radius by which a curve may be off its circle.
constexpr double kArcShare = 0.01;

Point2 pointOf(const CubicCurve& c, double t) {
    const double s = 1 - t;
    const double a = s * s * s, b = 3 * s * s * t, d = 3 * s * t * t, e = t * t * t;
    return {a * c[0].x + b * c[1].x + d * c[2].x + e * c[3].x,
            a * c[0].y + b * c[1].y + d * c[2].y + e * c[3].y};
}

}  // namespace

int arcPieces(double sweep, double radius) {
    const double share = std::min(1.0, kCurveSagitta / radius);
    const double per_turn =
        std::clamp(std::numbers::pi / std::acos(1 - share), kFewestPieces, kMostPieces);
    return std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / kFullTurn * per_turn - 1e-9)));
}

void appendCubic(const CubicCurve& curve, Polygon& points) {
    // The curve lies between its control points: pieces of a line would only be short ones.
    const Segment2 chord{curve[0], curve[3]};
    if (distance(curve[1], chord) <= kCurveSagitta && distance(curve[2], chord) <= kCurveSagitta) {
        points.push_back(curve[3]);
        return;
    }
    // A chord over a step h of the parameter is off by at most h² / 8 of the second derivative,
    // which is largest at an end: 6 times the second difference of the control points.
    const auto second = [&](std::size_t i) {
        return length((curve[i + 1] - curve[i]) - (curve[i + 2] - curve[i + 1]));
    };
    const double bend = 6 * std::max(second(0), second(1));
    const double wanted = std::sqrt(bend / (8 * kCurveSagitta));
    const int count = static_cast<int>(std::ceil(std::clamp(wanted, 1.0, kMostPieces)));
    for (int i = 1; i < count; ++i) points.push_back(pointOf(curve, double(i) / count));
    points.push_back(curve[3]);
}

std::optional<Point2> arcCenter(const CubicCurve& curve) {
    const Vec2 from = curve[1] - curve[0], to = curve[3] - curve[2];
    const Vec2 along = curve[3] - curve[0];
    const double turn = cross(from, to);
    // The normals of both ends meet in the centre.
    if (std::abs(turn) < 1e-6 * length(from) * length(to) || length(along) == 0)
        return std::nullopt;
    const double share = dot(along, to) / turn;
    const Point2 center = curve[0] + share * perpendicular(from);
    const double radius = distance(center, curve[0]);
    for (const double t : {0.25, 0.5, 0.75, 1.0})
        if (!(std::abs(distance(center, pointOf(curve, t)) - radius) <= kArcShare * radius))
            return std::nullopt;
    return center;
}

}  // namespace ispace
