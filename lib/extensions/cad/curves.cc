// SPDX-License-Identifier: GPL-3.0-or-later
// Straight pieces of curves. Bounds: a chord over the angle a of a circle is r (1 - cos(a / 2))
// off; over a step h of the parameter of a cubic h^2 / 8 of its greatest second derivative, which
// lies at an end; these hold up to kMaxPieces pieces. Splines (C. de Boor, On calculating with
// B-splines, 1972) are halved until three points of each piece are within half of kCurveSagitta, at
// most 12 times between two knots: a test by samples, no bound. All are in metres, after scaling,
// so a drawing gets as many points as its plan needs, whatever its unit.
#include "extensions/cad/curves.h"

#include <algorithm>
#include <numbers>

#include "geom/predicates.h"

namespace ispace::cad {

namespace {

/// Least and largest number of pieces in a full circle; the latter for 10 km.
constexpr double kMinPieces = 8, kMaxPieces = 7200;

constexpr int kMaxDegree = 15;
constexpr int kMaxHalvings = 12;  // of a span between two knots

/// Tolerance of a curve that counts as a circle, as share of the radius.
constexpr double kArcShare = 0.01;

Point2 pointOf(const CubicCurve& c, double t) {
    const double s = 1 - t;
    const double a = s * s * s, b = 3 * s * s * t, d = 3 * s * t * t, e = t * t * t;
    return {a * c[0].x + b * c[1].x + d * c[2].x + e * c[3].x,
            a * c[0].y + b * c[1].y + d * c[2].y + e * c[3].y};
}

/// Between two knots that differ.
class SplineSpan {
  public:
    SplineSpan(const SplineCurve& spline, std::size_t knot) : spline_(spline), knot_(knot) {}

    [[nodiscard]] double begin() const { return spline_.knots[knot_]; }
    [[nodiscard]] double end() const { return spline_.knots[knot_ + 1]; }

    /// By de Boor, in homogeneous coordinates.
    [[nodiscard]] Point2 at(double u) const {
        const auto degree = static_cast<std::size_t>(spline_.degree);
        const std::vector<double>& knots = spline_.knots;
        const std::size_t first = knot_ - degree;
        std::array<std::array<double, 3>, kMaxDegree + 1> d{};
        for (std::size_t j = 0; j <= degree; ++j) {
            const Point2 p = spline_.controls[first + j];
            const double weight = spline_.weights.empty() ? 1 : spline_.weights[first + j];
            d[j] = {weight * p.x, weight * p.y, weight};
        }
        for (std::size_t r = 1; r <= degree; ++r)
            for (std::size_t j = degree; j >= r; --j) {
                const double low = knots[first + j], high = knots[knot_ + 1 + j - r];
                const double share = (u - low) / (high - low);
                for (std::size_t i = 0; i < 3; ++i)
                    d[j][i] = (1 - share) * d[j - 1][i] + share * d[j][i];
            }
        return {d[degree][0] / d[degree][2], d[degree][1] / d[degree][2]};
    }

    /// Adds points behind the one at `from`, up to the one at `to`.
    void append(double from, double to, Point2 begin, Point2 end, int halvings, Polygon& points,
                std::size_t most) const {
        if (points.size() > most) return;
        const auto point_at = [&](double share) { return at(from + share * (to - from)); };
        const Point2 middle = point_at(0.5);
        const Segment2 chord{begin, end};
        const bool straight = distance(middle, chord) <= kCurveSagitta / 2 &&
                              distance(point_at(0.25), chord) <= kCurveSagitta / 2 &&
                              distance(point_at(0.75), chord) <= kCurveSagitta / 2;
        if (straight || halvings == kMaxHalvings) {
            points.push_back(end);
            return;
        }
        const double half = from + (to - from) / 2;
        append(from, half, begin, middle, halvings + 1, points, most);
        append(half, to, middle, end, halvings + 1, points, most);
    }

  private:
    const SplineCurve& spline_;
    std::size_t knot_;
};

}  // namespace

int arcPieces(double sweep, double radius) {
    const double share = std::min(1.0, kCurveSagitta / radius);
    const double per_turn =
        std::clamp(std::numbers::pi / std::acos(1 - share), kMinPieces, kMaxPieces);
    return std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / kFullTurn * per_turn - 1e-9)));
}

void appendCubic(const CubicCurve& curve, Polygon& points) {
    // The curve lies in the hull of its control points: a flat one is a single piece.
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
    const int count = static_cast<int>(std::ceil(std::clamp(wanted, 1.0, kMaxPieces)));
    for (int i = 1; i < count; ++i) points.push_back(pointOf(curve, double(i) / count));
    points.push_back(curve[3]);
}

std::string splineFault(const SplineCurve& spline) {
    const auto& [degree, knots, controls, weights] = spline;
    if (degree < 1 || degree > kMaxDegree)
        return "degree " + std::to_string(degree) + ", wanted 1 to " + std::to_string(kMaxDegree);
    const auto order = static_cast<std::size_t>(degree) + 1;
    if (controls.size() < order)
        return std::to_string(controls.size()) + " control points, wanted " +
               std::to_string(order) + " or more";
    if (knots.size() != controls.size() + order)
        return std::to_string(knots.size()) + " knots, wanted " +
               std::to_string(controls.size() + order);
    if (!std::is_sorted(knots.begin(), knots.end())) return "knots that go back";
    if (!(knots[order - 1] < knots[controls.size()])) return "knots that are all the same";
    if (!weights.empty() && weights.size() != controls.size())
        return std::to_string(weights.size()) + " weights, wanted " +
               std::to_string(controls.size());
    if (std::any_of(weights.begin(), weights.end(), [](double w) { return !(w > 0); }))
        return "a weight that is not above 0";
    return "";
}

Polygon splinePoints(const SplineCurve& spline, std::size_t most) {
    Polygon points;
    for (auto k = static_cast<std::size_t>(spline.degree); k < spline.controls.size(); ++k) {
        const SplineSpan span(spline, k);
        if (!(span.begin() < span.end()) || points.size() > most) continue;
        const Point2 begin = span.at(span.begin()), end = span.at(span.end());
        if (points.empty()) points.push_back(begin);
        span.append(span.begin(), span.end(), begin, end, 0, points, most);
    }
    return points;
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

}  // namespace ispace::cad
