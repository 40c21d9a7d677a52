// SPDX-License-Identifier: GPL-3.0-or-later
// Maps the border of a camera's picture, distorted by the lens, to a curve on a level plane.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "coverage/shadow_footprint.h"
#include "scene/sensor/camera.h"

namespace ispace {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kHalvings = 52;

/// Finds by bisection the last point inside, between a point inside and one outside.
template <typename IsInside>
double lastInside(double inside, double outside, IsInside is_inside) {
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = inside + (outside - inside) / 2;
        (is_inside(middle) ? inside : outside) = middle;
    }
    return inside;
}

/// A smooth piece of the border: along a side of the picture, or along the circle at which the lens
/// ends. Pieces run counter-clockwise around the picture as the camera sees it.
struct Piece {
    int side = 0;                ///< 4: the circle
    double first = 0, last = 1;  ///< parameters: 0 to 1 on a side, radians on the circle
};
constexpr int kCircle = 4;

/// The border that encloses the directions in a picture.
class Border {
  public:
    explicit Border(const Camera& camera) : camera_(camera) {
        std::vector<Piece> sides;
        for (int side = 0; side < kCircle; ++side) addSide(side, sides);
        if (sides.empty()) {
            shows_all_ = camera.holds({camera.cx, camera.cy});
            // At 180 degrees the circle shrinks to the point behind the camera.
            constexpr double kPoint = 1e-6;
            if (shows_all_ && camera.widest.radians() < kPi - kPoint)
                pieces_.push_back({kCircle, 0, 2 * kPi});
            return;
        }
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const Piece& piece = sides[i];
            const Piece& next = sides[i + 1 == sides.size() ? 0 : i + 1];
            pieces_.push_back(piece);
            const bool meets =
                piece.last == 1 && next.first == 0 && next.side == (piece.side + 1) % kCircle;
            if (!meets) addArc(at(piece, piece.last), at(next, next.first));
        }
    }
    [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
    /// Tells apart the two cases without pieces: every direction is in the picture, or no
    /// direction.
    [[nodiscard]] bool showsAll() const { return shows_all_; }

    /// Returns a unit direction in the camera's frame.
    [[nodiscard]] Vec3 at(const Piece& piece, double t) const {
        if (piece.side == kCircle) return onCircle(t);
        const PixelPoint place = onSide(piece.side, t);
        if (const auto ray = camera_.ray(place)) return *ray;
        return onCircle(std::atan2(camera_.cy - place.row, place.column - camera_.cx));
    }

  private:
    /// `around`: 0 is right in the picture, a quarter turn is up.
    [[nodiscard]] Vec3 onCircle(double around) const {
        const auto [c, s] = cosSin(camera_.widest);
        return {c, -s * std::cos(around), s * std::sin(around)};
    }
    /// Sides in order: lower, right, upper, left.
    [[nodiscard]] PixelPoint onSide(int side, double t) const {
        const double left = -0.5, right = camera_.columns - 0.5, top = -0.5,
                     bottom = camera_.rows - 0.5;
        const std::array<PixelPoint, 5> corners = {
            {{left, bottom}, {right, bottom}, {right, top}, {left, top}, {left, bottom}}};
        const PixelPoint a = corners[static_cast<std::size_t>(side)];
        const PixelPoint b = corners[static_cast<std::size_t>(side) + 1];
        if (t == 1) return b;
        return {a.column + t * (b.column - a.column), a.row + t * (b.row - a.row)};
    }
    /// Adds the pieces of a side within the lens's field of view.
    void addSide(int side, std::vector<Piece>& pieces) const {
        const auto shows = [&](double t) { return camera_.ray(onSide(side, t)).has_value(); };
        // The point nearest to the centre is the last one that the lens maps.
        const bool is_level = side % 2 == 0;
        const PixelPoint a = onSide(side, 0), b = onSide(side, 1);
        const double nearest = is_level ? (camera_.cx - a.column) / (b.column - a.column)
                                        : (camera_.cy - a.row) / (b.row - a.row);
        constexpr int kSteps = 32;
        std::vector<double> steps = {std::clamp(nearest, 0.0, 1.0)};
        for (int i = 0; i <= kSteps; ++i) steps.push_back(static_cast<double>(i) / kSteps);
        std::sort(steps.begin(), steps.end());
        bool was_shown = false;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const bool is_shown = shows(steps[i]);
            if (is_shown && !was_shown)
                pieces.push_back({side, i == 0 ? 0 : lastInside(steps[i], steps[i - 1], shows), 1});
            if (!is_shown && was_shown)
                pieces.back().last = lastInside(steps[i - 1], steps[i], shows);
            was_shown = is_shown;
        }
        std::erase_if(pieces, [](const Piece& piece) { return !(piece.first < piece.last); });
    }
    void addArc(Vec3 from, Vec3 to) {
        const double first = std::atan2(from.z, -from.y);
        double last = std::atan2(to.z, -to.y);
        if (last <= first) last += 2 * kPi;
        pieces_.push_back({kCircle, first, last});
    }

    const Camera& camera_;
    std::vector<Piece> pieces_;
    bool shows_all_ = false;
};

/// Number of steps in which a piece is searched for crossings with a plane.
constexpr int kSearchSteps = 64;

/// Traces the border on a plane above or below the sensor. Points at or beyond the horizon are
/// replaced by a circle about the foot, well out of reach.
class Tracer {
  public:
    Tracer(const FieldOfView& view, const Border& border, double drop, double reach)
        : view_(view),
          border_(border),
          drop_(drop),
          beyond_(2 * std::hypot(reach, drop)),
          least_(std::fabs(drop) / beyond_) {}

    std::optional<std::vector<Curve>> run() {
        traceAll();
        if (parts_.empty()) {
            const bool sees_foot = view_.points(toLocal({0, 0, drop_}));
            return sees_foot ? std::nullopt : std::optional(std::vector<Curve>());
        }
        if (is_closed_) return closed(std::move(parts_.front().curve));
        return linked();
    }

  private:
    /// A part of the border nearer than the circle.
    struct Part {
        Curve curve;
        double entry = 0, exit = 0;  ///< angles at which it leaves and meets the circle, radians
        bool is_used = false;
    };

    [[nodiscard]] Vec3 toLocal(Vec3 way) const {
        const Frame3& f = view_.frame;
        return {dot(way, f.forward), dot(way, f.left), dot(way, f.up)};
    }
    /// If the camera looks up at the plane, the border seen from above runs the other way.
    [[nodiscard]] Vec3 direction(const Piece& piece, double t) const {
        const double share = drop_ < 0 ? t : 1 - t;
        return view_.frame * border_.at(piece, piece.first + share * (piece.last - piece.first));
    }
    [[nodiscard]] bool isNear(Vec3 way) const {
        return (drop_ < 0 ? -way.z : way.z) >= least_ * length(way);
    }
    [[nodiscard]] Point2 onPlane(Vec3 way) const {
        const double toward = std::max(drop_ < 0 ? -way.z : way.z, least_ / 2);
        const double far = std::fabs(drop_) / toward;
        return {far * way.x, far * way.y};
    }

    void traceAll() {
        std::vector<Piece> pieces = border_.pieces();
        if (drop_ > 0) std::reverse(pieces.begin(), pieces.end());
        bool is_open = false;  // the previous part continues
        for (const Piece& piece : pieces) trace(piece, is_open);
        if (parts_.empty() || !is_open || !isNear(direction(pieces.front(), 0))) return;
        if (parts_.size() == 1) {
            is_closed_ = true;
            return;
        }
        // The last part continues in the first.
        Part& last = parts_.back();
        last.curve.insert(last.curve.end(), parts_.front().curve.begin(),
                          parts_.front().curve.end());
        last.exit = parts_.front().exit;
        parts_.front() = std::move(last);
        parts_.pop_back();
    }

    void trace(const Piece& piece, bool& is_open) {
        const auto is_near = [&](double t) { return isNear(direction(piece, t)); };
        const auto angle = [&](double t) {
            const Vec3 way = direction(piece, t);
            return std::atan2(way.y, way.x);
        };
        double begin = 0;
        bool was_near = is_near(0);
        if (was_near && !is_open) parts_.push_back({{}, angle(0)});
        if (!was_near && is_open) parts_.back().exit = angle(0);
        is_open = was_near;
        for (int i = 1; i <= kSearchSteps; ++i) {
            const double t = static_cast<double>(i) / kSearchSteps;
            const double before = static_cast<double>(i - 1) / kSearchSteps;
            const bool now = is_near(t);
            if (now && !was_near) {
                begin = lastInside(t, before, is_near);
                parts_.push_back({{}, angle(begin)});
            }
            if (!now && was_near) {
                const double end = lastInside(before, t, is_near);
                follow(piece, begin, end);
                parts_.back().exit = angle(end);
            }
            was_near = now;
        }
        if (was_near) follow(piece, begin, 1);
        is_open = was_near;
    }
    void follow(const Piece& piece, double begin, double end) {
        if (begin < end)
            ispace::follow([&](double t) { return onPlane(direction(piece, t)); }, begin, end,
                           parts_.back().curve);
    }

    [[nodiscard]] Point2 onCircle(double angle) const {
        const double radius = std::sqrt(beyond_ * beyond_ - drop_ * drop_);
        return {radius * std::cos(angle), radius * std::sin(angle)};
    }
    void addCircle(double from, double to, Curve& curve) const {
        if (curve.empty())
            curve.push_back({onCircle(from), onCircle(from)});
        else
            curve.push_back({curve.back().to, onCircle(from)});
        ispace::follow([this](double angle) { return onCircle(angle); }, from, to, curve);
    }
    static void close(Curve& curve) {
        if (curve.back().to != curve.front().from)
            curve.push_back({curve.back().to, curve.front().from});
        std::erase_if(curve, [](const CurveEdge& edge) { return edge.from == edge.to; });
    }

    /// Returns the area of a closed border without far points, or its complement.
    [[nodiscard]] std::vector<Curve> closed(Curve curve) const {
        close(curve);
        if (signedArea(curve) > 0) return {std::move(curve)};
        Curve around;
        addCircle(0, 2 * kPi, around);
        close(around);
        return {std::move(around), std::move(curve)};
    }
    /// The area in view lies on the left: from the end of a part, the circle runs counter-clockwise
    /// to the start of the next part.
    std::vector<Curve> linked() {
        std::vector<Curve> curves;
        const auto turn = [](double from, double to) {
            const double angle = std::fmod(to - from, 2 * kPi);
            return angle < 0 ? angle + 2 * kPi : angle;
        };
        for (Part& first : parts_) {
            if (first.is_used) continue;
            Curve curve;
            Part* part = &first;
            while (!part->is_used) {
                part->is_used = true;
                if (!curve.empty() && !part->curve.empty())
                    curve.push_back({curve.back().to, part->curve.front().from});
                curve.insert(curve.end(), part->curve.begin(), part->curve.end());
                const double exit = part->exit;
                part = &*std::min_element(parts_.begin(), parts_.end(),
                                          [&](const Part& a, const Part& b) {
                                              return turn(exit, a.entry) < turn(exit, b.entry);
                                          });
                addCircle(exit, exit + turn(exit, part->entry), curve);
            }
            close(curve);
            if (!curve.empty()) curves.push_back(std::move(curve));
        }
        return curves;
    }

    const FieldOfView& view_;
    const Border& border_;
    double drop_, beyond_, least_;
    std::vector<Part> parts_;
    bool is_closed_ = false;
};

/// Computes the bearings in view in the plane through the sensor, as sectors about the foot.
std::optional<std::vector<Curve>> bearingsInView(const FieldOfView& view, const Border& border,
                                                 double reach) {
    std::vector<double> turns;
    for (const Piece& piece : border.pieces()) {
        const auto way = [&](double t) {
            return view.frame * border.at(piece, piece.first + t * (piece.last - piece.first));
        };
        const auto is_over = [&](double t) { return way(t).z >= 0; };
        for (int i = 1; i <= kSearchSteps; ++i) {
            const double before = static_cast<double>(i - 1) / kSearchSteps;
            const double t = static_cast<double>(i) / kSearchSteps;
            if (is_over(before) == is_over(t)) continue;
            const Vec3 cut = way(is_over(before) ? lastInside(before, t, is_over)
                                                 : lastInside(t, before, is_over));
            turns.push_back(std::atan2(cut.y, cut.x));
        }
    }
    std::sort(turns.begin(), turns.end());
    const auto is_seen = [&](double angle) {
        const Point3 origin = view.frame.origin;
        return view.points(
            view.frame.toLocal({origin.x + std::cos(angle), origin.y + std::sin(angle), origin.z}));
    };
    if (turns.empty()) return is_seen(0) ? std::nullopt : std::optional(std::vector<Curve>());
    std::vector<Curve> curves;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const double from = turns[i];
        const double to = i + 1 < turns.size() ? turns[i + 1] : turns.front() + 2 * kPi;
        if (!(from < to) || !is_seen((from + to) / 2)) continue;
        constexpr int kChords = 12;
        Polygon sector = {{0, 0}};
        for (int k = 0; k <= kChords; ++k) {
            const double angle = from + (to - from) * k / kChords;
            sector.push_back({2 * reach * std::cos(angle), 2 * reach * std::sin(angle)});
        }
        curves.push_back(curveOf(sector));
    }
    return curves;
}

}  // namespace

std::optional<std::vector<Curve>> pictureOnPlane(const FieldOfView& view, double drop,
                                                 double reach) {
    const Border border(*view.camera);
    if (border.pieces().empty())
        return border.showsAll() ? std::nullopt : std::optional(std::vector<Curve>());
    if (drop == 0) return bearingsInView(view, border, reach);
    return Tracer(view, border, drop, reach).run();
}

}  // namespace ispace
