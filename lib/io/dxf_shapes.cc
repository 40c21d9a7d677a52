// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/dxf_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/curves.h"
#include "io/import_records.h"

namespace ispace {

namespace {

constexpr int kDeepest = 16;                    // blocks in blocks
constexpr std::size_t kFreePoints = 10'000;     // whatever the file's size …
constexpr std::size_t kPointsPerEntity = 1000;  // … and for each entity in it

/// Beyond these a bulge is a straight line, or a circle of which an end is missing.
constexpr double kLeastBulge = 1e-9, kLargestBulge = 1e4;

constexpr double kFullTurn = 2 * std::numbers::pi;

constexpr Affine kMirror{{-1, 0}, {0, 1}, {}};

/// Ends of a spline this near, in metres, make it closed.
constexpr double kSameEnd = 1e-6;

class Expander {
  public:
    Expander(const DxfDrawing& drawing, const std::string& name, std::size_t most,
             MissingBlocks& missing, const LayerFilter& wanted)
        : drawing_(drawing),
          name_(name),
          most_(most),
          total_(kFreePoints + kPointsPerEntity * drawing.size()),
          budget_(std::min(most, total_)),
          wanted_(wanted),
          missing_(missing) {}

    std::vector<PlanShape> expand(double metres_per_unit) {
        const Affine metres{{metres_per_unit, 0}, {0, metres_per_unit}, {}};
        add(drawing_.entities, metres, "", 0);
        return std::move(shapes_);
    }

  private:
    [[noreturn]] void fail(const DxfEntity& entity, const std::string& message) const {
        throw FormatError(
            Diagnostic{displayName(name_), entity.line, entity.line == 0 ? 0 : 1, message});
    }

    void spend(const DxfEntity& entity, std::size_t points) {
        if (points > budget_ && most_ <= total_)
            fail(entity, "the drawing comes to more than " + std::to_string(most_) +
                             " points; leave layers out, for example with --wall-layer 'A-WALL*'");
        if (points > budget_)
            fail(entity,
                 "the blocks of this drawing make too many lines of it; is one inserted by "
                 "mistake, or in too large a grid?");
        budget_ -= points;
    }

    void add(const std::vector<DxfEntity>& entities, const Affine& outer, const std::string& layer,
             int depth) {
        for (const DxfEntity& entity : entities) {
            const Affine frame = entity.mirrored ? outer * kMirror : outer;
            const bool inherits = depth > 0 && entity.layer == "0";
            const std::string& own = inherits ? layer : entity.layer;
            if (const auto* insert = std::get_if<DxfInsert>(&entity.shape))
                addInsert(entity, *insert, frame, own, depth);
            else
                addShape(entity, frame, own, depth);
        }
    }

    void addInsert(const DxfEntity& entity, const DxfInsert& insert, const Affine& outer,
                   const std::string& layer, int depth) {
        const auto block = drawing_.blocks.find(insert.block);
        if (block == drawing_.blocks.end()) {
            ++missing_[insert.block];
            return;
        }
        if (depth == kDeepest)
            fail(entity, "blocks in each other more than " + std::to_string(kDeepest) +
                             " deep: does " + excerpt(insert.block) + " contain itself?");
        const Vec2 along = unitVector(insert.turn), across = perpendicular(along);
        const Vec2 x = insert.scale_x * along, y = insert.scale_y * across;
        const Point2 base = block->second.base;
        for (int row = 0; row < std::max(1, insert.rows); ++row)
            for (int column = 0; column < std::max(1, insert.columns); ++column) {
                spend(entity, 1);
                const Point2 at = insert.at + (column * insert.column_step) * along +
                                  (row * insert.row_step) * across;
                const Affine placed{x, y, at - (Point2() + base.x * x + base.y * y)};
                add(block->second.entities, outer * placed, layer, depth + 1);
            }
    }

    void addShape(const DxfEntity& entity, const Affine& frame, const std::string& layer,
                  int depth) {
        shape_ = {};
        shape_.layer = layer;
        shape_.path.line = entity.line;
        if (wanted_ && !wanted_(layer)) {
            if (depth > 0) spend(entity, 1);
            shapes_.push_back(std::move(shape_));
            return;
        }
        if (const auto* polyline = std::get_if<DxfPolyline>(&entity.shape))
            addPolyline(*polyline, frame);
        else if (const auto* arc = std::get_if<DxfArc>(&entity.shape))
            addArc(entity, *arc, frame);
        else if (const auto* ellipse = std::get_if<DxfEllipse>(&entity.shape))
            addEllipse(*ellipse, frame);
        else if (const auto* spline = std::get_if<DxfSpline>(&entity.shape))
            addSpline(entity, *spline, frame);
        spend(entity, shape_.path.points.size());
        for (const Point2 p : shape_.path.points)
            if (!(std::max(std::abs(p.x), std::abs(p.y)) <= kFarthestPlan))
                fail(entity, "lies more than " + formatDouble(kFarthestPlan / 1000) +
                                 " km from the origin: are the units right (--units)?");
        if (shape_.path.points.size() >= 2) shapes_.push_back(std::move(shape_));
    }

    void addPolyline(const DxfPolyline& polyline, const Affine& frame) {
        const auto& vertices = polyline.vertices;
        Polygon& points = shape_.path.points;
        shape_.path.closed = polyline.closed && vertices.size() > 1;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            points.push_back(frame * vertices[i].at);
            const bool is_last = i + 1 == vertices.size();
            if (is_last && !shape_.path.closed) break;
            addPiece(vertices[i], vertices[is_last ? 0 : i + 1].at, frame);
        }
    }

    /// What lies between a vertex and the next one.
    void addPiece(const DxfPolyline::Vertex& from, Point2 to, const Affine& frame) {
        PlanChord chord{{frame * from.at, frame * to}, {}};
        const double bulge = from.bulge;
        const Vec2 along = to - from.at;
        if (std::abs(bulge) > kLeastBulge && std::abs(bulge) < kLargestBulge && length(along) > 0) {
            const double aside = (1 - bulge * bulge) / (4 * bulge);
            const Point2 center = from.at + 0.5 * along + aside * perpendicular(along);
            const Vec2 spoke = from.at - center;
            const double sweep = 4 * std::atan(bulge);
            const int count = arcPieces(sweep, length(spoke) * frame.largestScale());
            for (int i = 1; i < count; ++i)
                shape_.path.points.push_back(frame * (center + turned(spoke, sweep * i / count)));
            chord.center = frame * center;
        }
        shape_.chords.push_back(chord);
    }

    static Vec2 turned(Vec2 v, double radians) {
        return std::cos(radians) * v + std::sin(radians) * perpendicular(v);
    }

    void addArc(const DxfEntity& entity, const DxfArc& arc, const Affine& frame) {
        if (arc.radius == 0) return;  // shows nothing, as a line of no length
        if (!(arc.radius > 0)) fail(entity, "a radius of " + formatDouble(arc.radius));
        const bool full = arc.from == Angle() && arc.to == Angle::degrees(360);
        double degrees = std::fmod(arc.to.degrees() - arc.from.degrees(), 360);
        if (degrees <= 0) degrees += 360;
        const int count = arcPieces(degrees / 360 * kFullTurn, arc.radius * frame.largestScale());
        shape_.path.closed = full;
        for (int i = 0; i < count + (full ? 0 : 1); ++i) {
            const Angle angle =
                i == count ? arc.to : arc.from + Angle::degrees(degrees * i / count);
            shape_.path.points.push_back(frame * (arc.center + arc.radius * unitVector(angle)));
        }
        if (!full)
            shape_.chords.push_back(
                {{shape_.path.points.front(), shape_.path.points.back()}, frame * arc.center});
    }

    void addEllipse(const DxfEllipse& ellipse, const Affine& frame) {
        double sweep = std::fmod(ellipse.to - ellipse.from, kFullTurn);
        if (sweep <= 1e-9) sweep += kFullTurn;
        const bool full = sweep > kFullTurn - 1e-6;
        const double radius = std::max(length(ellipse.major), length(ellipse.minor));
        if (!(radius > 0)) return;
        const int count = arcPieces(sweep, radius * frame.largestScale());
        shape_.path.closed = full;
        for (int i = 0; i < count + (full ? 0 : 1); ++i) {
            const double t = ellipse.from + sweep * i / count;
            shape_.path.points.push_back(frame * (ellipse.center + std::cos(t) * ellipse.major +
                                                  std::sin(t) * ellipse.minor));
        }
    }

    void addSpline(const DxfEntity& entity, DxfSpline spline, const Affine& frame) {
        for (Point2& control : spline.controls) control = frame * control;
        Polygon& points = shape_.path.points;
        points = splinePoints(spline, budget_);
        if (points.size() > budget_) spend(entity, points.size());  // refuses
        shape_.path.closed = distance(points.front(), points.back()) <= kSameEnd;
        if (shape_.path.closed) points.pop_back();
    }

    const DxfDrawing& drawing_;
    const std::string& name_;
    std::size_t most_, total_, budget_;
    const LayerFilter& wanted_;
    MissingBlocks& missing_;
    std::vector<PlanShape> shapes_;
    PlanShape shape_;  // in the making
};

}  // namespace

std::vector<PlanShape> shapesOf(const DxfDrawing& drawing, double metres_per_unit,
                                const std::string& name, std::size_t most, MissingBlocks& missing,
                                const LayerFilter& wanted) {
    return Expander(drawing, name, most, missing, wanted).expand(metres_per_unit);
}

}  // namespace ispace
