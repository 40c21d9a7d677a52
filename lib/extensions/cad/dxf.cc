// SPDX-License-Identifier: GPL-3.0-or-later
// A plan from a parsed DXF drawing (dxf_drawing.h). Blocks are expanded here, since their layers,
// scales and mirrors depend on the insert; a block of few bytes may be inserted a million times, so
// each insert, entity and point is paid for. Then io/plan does the rest, as for SVG. A drawing may
// be imported several times: with another unit, or with layers of walls alone, so that a message
// can name the effect of an option instead of guessing it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "base/budget.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "extensions/cad/cad.h"
#include "extensions/cad/dxf_drawing.h"
#include "geom/tolerance.h"
#include "io/plan/drawing_unit.h"
#include "io/plan/line_plan.h"

namespace ispace::cad {

namespace {

constexpr int kMaxBlockDepth = 16;  // blocks in blocks

/// Blocks that the file lacks (an unbound external reference), with their numbers of inserts.
using MissingBlocks = std::map<std::string, std::size_t>;

/// Beyond these a bulge is a straight line, or a full circle.
constexpr double kMinBulge = 1e-9, kMaxBulge = 1e4;

/// Widths of lines and of hatches, in metres, that are the thickness of walls.
constexpr double kThinnestDrawn = 0.04, kThickestDrawn = 0.8;
/// Metres: hatches with a shorter boundary are no walls.
constexpr double kLeastAround = 2;

/// Units of Budget for an entity that is not read: its names are copied.
constexpr std::size_t kUnreadEntityWork = 20;

constexpr Affine kMirror{{-1, 0}, {0, 1}, {}};

enum class Hatches { OfWalls, All };

/// A filled area that is wider than walls: a floor, or a pier or a thick wall that no line
/// outlines.
struct WideFill {
    std::vector<Polygon> rings;  ///< in metres; filled by the even-odd rule
    UnreadThing thing;

    [[nodiscard]] bool covers(Point2 p) const {
        return std::count_if(rings.begin(), rings.end(),
                             [p](const Polygon& ring) { return locate(ring, p) == Side::Inside; }) %
                   2 ==
               1;
    }
};

/// Adds the fills that may be walls: they do not cover a kept room, and most of their boundary
/// follows no line.
void addWideFills(std::vector<WideFill> fills, std::span<const PlanRegion> rooms,
                  std::span<const Segment2> lines, Budget& work, std::vector<UnreadThing>& unread) {
    constexpr double kStep = 0.25, kOnBoundary = 0.05;  // metres
    constexpr int kMostSteps = 40;                      // of a side
    std::erase_if(fills, [&](const WideFill& fill) {
        return std::any_of(rooms.begin(), rooms.end(),
                           [&](const PlanRegion& room) { return fill.covers(room.inside); });
    });
    if (fills.empty()) return;
    const NearSegments search(lines, work);
    for (WideFill& fill : fills) {
        double whole = 0, drawn = 0;
        for (const Polygon& ring : fill.rings)
            forEachEdge(ring, [&](const Segment2& side) {
                const double length = distance(side.a, side.b);
                const int steps = std::clamp(static_cast<int>(length / kStep), 1, kMostSteps);
                whole += length;
                for (int i = 0; i < steps; ++i) {
                    const Point2 p = side.a + (i + 0.5) / steps * (side.b - side.a);
                    const auto near = search.near(p, kOnBoundary);
                    if (std::any_of(near.begin(), near.end(), [&](std::size_t k) {
                            return distance(p, lines[k]) <= kOnBoundary;
                        }))
                        drawn += length / steps;
                }
            });
        if (2 * drawn < whole) unread.push_back(std::move(fill.thing));
    }
}

/// The drawing in metres with all inserts of blocks expanded, entities on layer 0 of a block on the
/// layer of its insert. Each insert, entity and point spends from the budget; shapes on unused
/// layers have no points.
class Expander {
  public:
    Expander(const DxfDrawing& drawing, const std::string& name, const Budget& budget,
             MissingBlocks& missing, LayerSorter& layers)
        : drawing_(drawing), name_(name), budget_(budget), layers_(layers), missing_(missing) {}

    /// \param hatches all of them, whatever their width, or those that may be walls
    std::vector<PlanShape> expand(double metres_per_unit, Hatches hatches = Hatches::OfWalls) {
        hatches_ = hatches;
        const Affine metres{{metres_per_unit, 0}, {0, metres_per_unit}, {}};
        shapes_.reserve(drawing_.entities.size());
        add(drawing_.entities, metres, "", 0);
        addUnread(drawing_.unread, metres, "", 0);
        return std::move(shapes_);
    }

    /// Entities that may be walls and were not read, on layers that are used, in metres.
    [[nodiscard]] const std::vector<UnreadThing>& unread() const { return unread_; }
    /// Returns filled areas that may be walls, see addWideFills().
    [[nodiscard]] const std::vector<WideFill>& wideFills() const { return fills_; }

    /// Moves a drawing of which most stands in surveyors' coordinates to the origin. \return by
    /// what \throws FormatError: shapes beyond kMaxPlanCoordinate
    std::optional<Vec2> moveHome(std::vector<PlanShape>& shapes) {
        const auto way = movedHome(shapes, name_);
        for (UnreadThing& thing : unread_)
            if (way && !thing.extent.empty())
                thing.extent = {thing.extent.low - *way, thing.extent.high - *way};
        for (WideFill& fill : fills_) {
            if (!way) break;
            fill.thing.extent = {fill.thing.extent.low - *way, fill.thing.extent.high - *way};
            for (Polygon& ring : fill.rings)
                for (Point2& p : ring) p = p - *way;
        }
        return way;
    }

  private:
    [[noreturn]] void fail(const DxfEntity& entity, const std::string& message) const {
        failFile(name_, message, entity.line);
    }

    void spend(const DxfEntity& entity, std::size_t units) { spendAt(entity.line, units); }

    void spendAt(int line, std::size_t units) {
        if (!budget_.take(units))
            failFile(name_,
                     "blocks and curves of the drawing make " + budget_.excess() +
                         "; is a block inserted by mistake, or in too large a grid? --wall-layer "
                         "'A-WALL*' leaves layers out",
                     line);
    }

    /// Adds entities that were not read, in a block on the layer of its insert.
    void addUnread(const std::vector<UnreadThing>& things, const Affine& frame,
                   const std::string& layer, int depth) {
        for (const UnreadThing& thing : things) {
            spendAt(thing.line, kUnreadEntityWork);
            const std::string& own = layerOf(depth > 0 && thing.layer == "0" ? layer : thing.layer);
            if (!layers_.mayBeWall(own)) continue;
            UnreadThing& placed = unread_.emplace_back(thing);
            placed.layer = own;
            placed.extent = Box2();
            if (thing.extent.empty()) continue;
            const auto& [low, high] = thing.extent;
            for (const Point2 corner : {low, high, Point2{low.x, high.y}, Point2{high.x, low.y}})
                placed.extent.add(frame * corner);
        }
    }

    void add(const std::vector<DxfEntity>& entities, const Affine& outer, const std::string& layer,
             int depth) {
        for (const DxfEntity& entity : entities) {
            spend(entity, 1);
            const Affine frame = entity.mirrored ? outer * kMirror : outer;
            const bool inherits = depth > 0 && entity.layer == "0";
            const std::string& own = inherits ? layer : entity.layer;
            if (const auto* insert = std::get_if<DxfInsert>(&entity.shape))
                addInsert(entity, *insert, frame, own, depth);
            else
                addShape(entity, frame, layerOf(own));
        }
    }

    /// Returns the layer of the entity, unless an option names an enclosing block instead, or one
    /// is called as furniture and the layer not as walls.
    [[nodiscard]] const std::string& layerOf(const std::string& layer) {
        if (blocks_.empty() || layers_.isHidden(layer) || layers_.isNamed(layer)) return layer;
        bool may_be_thing = !isCalled(layer).walls;
        for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
            if (layers_.isNamed(**block)) return **block;
            may_be_thing = may_be_thing && !isCalled(**block).walls;
            if (may_be_thing && isCalled(**block).thing) return **block;
        }
        return layer;
    }

    /// Returns the layer, or the innermost enclosing block, with a name of walls; "" if there is
    /// none.
    [[nodiscard]] std::string wallsAround(const std::string& layer) {
        if (isCalled(layer).walls) return layer;
        const auto walls =
            std::find_if(blocks_.rbegin(), blocks_.rend(),
                         [this](const std::string* block) { return isCalled(*block).walls; });
        return walls == blocks_.rend() ? "" : **walls;
    }

    /// Caches isWallName() and isThingName() by name.
    struct Called {
        bool walls = false, thing = false;
    };
    [[nodiscard]] Called isCalled(const std::string& name) {
        const auto [found, is_new] = called_.try_emplace(name);
        if (is_new) found->second = {isWallName(name), isThingName(name)};
        return found->second;
    }

    void addInsert(const DxfEntity& entity, const DxfInsert& insert, const Affine& outer,
                   const std::string& layer, int depth) {
        const auto block = drawing_.blocks.find(insert.block);
        if (layers_.isHidden(layer)) return;
        if (block == drawing_.blocks.end() ||
            (block->second.is_external && block->second.entities.empty())) {
            ++missing_[insert.block];
            const bool is_external = block != drawing_.blocks.end();
            addUnread({{(is_external ? "external reference " : "missing block ") + insert.block,
                        entity.layer, insert.at, entity.line}},
                      outer, layer, depth);
            return;
        }
        if (depth == kMaxBlockDepth)
            fail(entity, "blocks in each other more than " + std::to_string(kMaxBlockDepth) +
                             " deep: does " + excerpt(insert.block) + " contain itself?");
        const Vec2 along = unitVector(insert.turn), across = perpendicular(along);
        const Vec2 x = insert.scale_x * along, y = insert.scale_y * across;
        const Point2 base = block->second.base;
        blocks_.push_back(&block->first);
        for (int row = 0; row < std::max(1, insert.rows); ++row)
            for (int column = 0; column < std::max(1, insert.columns); ++column) {
                spend(entity, 1);
                const Point2 at = insert.at + (column * insert.column_step) * along +
                                  (row * insert.row_step) * across;
                const Affine placed{x, y, at - (Point2() + base.x * x + base.y * y)};
                add(block->second.entities, outer * placed, layer, depth + 1);
                addUnread(block->second.unread, outer * placed, layer, depth + 1);
            }
        blocks_.pop_back();
    }

    void addShape(const DxfEntity& entity, const Affine& frame, const std::string& layer) {
        shape_ = {};
        shape_.layer = layer;
        shape_.path.line = entity.line;
        shape_.walls_in = wallsAround(layer);
        if (!layers_.isUsed(layer)) {
            shapes_.push_back(std::move(shape_));
            return;
        }
        if (const auto* polyline = std::get_if<DxfPolyline>(&entity.shape)) {
            addPolyline(entity, *polyline, frame);
            // Swings of doors are dashed, too.
            shape_.is_dashed =
                entity.is_dashed &&
                std::none_of(polyline->vertices.begin(), polyline->vertices.end(),
                             [](const auto& vertex) { return std::abs(vertex.bulge) > kMinBulge; });
        } else if (const auto* arc = std::get_if<DxfArc>(&entity.shape))
            addArc(entity, *arc, frame);
        else if (const auto* ellipse = std::get_if<DxfEllipse>(&entity.shape))
            addEllipse(entity, *ellipse, frame);
        else if (const auto* spline = std::get_if<DxfSpline>(&entity.shape))
            addSpline(entity, *spline, frame);
        else if (const auto* hatch = std::get_if<DxfHatch>(&entity.shape))
            return addHatch(entity, *hatch, frame);
        requireOnEarth(shape_, name_);
        if (shape_.path.points.size() >= 2) shapes_.push_back(std::move(shape_));
    }

    void addPolyline(const DxfEntity& entity, const DxfPolyline& polyline, const Affine& frame) {
        const auto& vertices = polyline.vertices;
        spend(entity, vertices.size());
        Polygon& points = shape_.path.points;
        shape_.path.closed = polyline.closed && vertices.size() > 1;
        const double width = polyline.width * frame.largestScale() / std::numbers::sqrt2;
        if (width >= kThinnestDrawn && width <= kThickestDrawn) shape_.path.thickness = width;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            points.push_back(frame * vertices[i].at);
            const bool is_last = i + 1 == vertices.size();
            if (is_last && !shape_.path.closed) break;
            addPiece(entity, vertices[i], vertices[is_last ? 0 : i + 1].at, frame);
        }
    }

    /// Adds the rings of a hatch that is as narrow as walls: their filling. Others are patterns of
    /// floors, which end where walls do, or of furniture.
    void addHatch(const DxfEntity& entity, const DxfHatch& hatch, const Affine& frame) {
        const PlanShape blank = shape_;
        std::vector<PlanShape> rings;
        for (const DxfPolyline& ring : hatch.rings) {
            shape_ = blank;
            addPolyline(entity, ring, frame);
            requireOnEarth(shape_, name_);
            rings.push_back(std::move(shape_));
        }
        double area = 0, around = 0;
        for (const PlanShape& ring : rings) {
            const Polygon& points = ring.path.points;
            const auto depth = std::count_if(rings.begin(), rings.end(), [&](const PlanShape& r) {
                return &r != &ring && locate(r.path.points, points.front()) == Side::Inside;
            });
            area += (depth % 2 == 0 ? 1 : -1) * std::abs(signedArea(points));
            for (std::size_t i = 0; i < ring.path.pieceCount(); ++i)
                around += distance(ring.path.piece(i).a, ring.path.piece(i).b);
        }
        const double width = around > 0 ? 2 * area / around : 0;
        const bool is_wall =
            width >= kThinnestDrawn && width <= kThickestDrawn && around >= kLeastAround;
        if (hatches_ == Hatches::OfWalls && !is_wall) {
            if (hatch.is_solid && width > kThickestDrawn && layers_.mayBeWall(blank.layer))
                addWideFill(entity, blank.layer, rings);
            return;
        }
        for (PlanShape& ring : rings) shapes_.push_back(std::move(ring));
    }

    void addWideFill(const DxfEntity& entity, const std::string& layer,
                     std::span<const PlanShape> rings) {
        WideFill& fill = fills_.emplace_back();
        fill.thing = {"HATCH of a colour, wider than walls", layer, {}, entity.line};
        if (const auto* const hatch = std::get_if<DxfHatch>(&entity.shape))
            fill.thing.at = hatch->rings.front().vertices.front().at;
        for (const PlanShape& ring : rings) {
            fill.rings.push_back(ring.path.points);
            for (const Point2 p : ring.path.points) fill.thing.extent.add(p);
        }
    }

    /// Adds the line or arc between a vertex and the next one.
    void addPiece(const DxfEntity& entity, const DxfPolyline::Vertex& from, Point2 to,
                  const Affine& frame) {
        PlanChord chord{{frame * from.at, frame * to}, {}};
        const double bulge = from.bulge;
        const Vec2 along = to - from.at;
        if (std::abs(bulge) > kMinBulge && std::abs(bulge) < kMaxBulge && length(along) > 0) {
            const double aside = (1 - bulge * bulge) / (4 * bulge);
            const Point2 center = from.at + 0.5 * along + aside * perpendicular(along);
            const Vec2 spoke = from.at - center;
            const double sweep = 4 * std::atan(bulge);
            const int count = arcPieces(sweep, length(spoke) * frame.largestScale());
            spend(entity, static_cast<std::size_t>(count));
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
        if (arc.radius == 0) return;  // invisible, like a line without length
        if (!(arc.radius > 0)) fail(entity, "a radius of " + formatDouble(arc.radius));
        const bool full = arc.from == Angle() && arc.to == Angle::degrees(360);
        double degrees = std::fmod(arc.to.degrees() - arc.from.degrees(), 360);
        if (degrees <= 0) degrees += 360;
        const int count = arcPieces(degrees / 360 * kFullTurn, arc.radius * frame.largestScale());
        spend(entity, static_cast<std::size_t>(count));
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

    void addEllipse(const DxfEntity& entity, const DxfEllipse& ellipse, const Affine& frame) {
        double sweep = std::fmod(ellipse.to - ellipse.from, kFullTurn);
        if (sweep <= 1e-9) sweep += kFullTurn;
        const bool full = sweep > kFullTurn - 1e-6;
        const double radius = std::max(length(ellipse.major), length(ellipse.minor));
        if (!(radius > 0)) return;
        const int count = arcPieces(sweep, radius * frame.largestScale());
        spend(entity, static_cast<std::size_t>(count));
        shape_.path.closed = full;
        for (int i = 0; i < count + (full ? 0 : 1); ++i) {
            const double t = ellipse.from + sweep * i / count;
            shape_.path.points.push_back(frame * (ellipse.center + std::cos(t) * ellipse.major +
                                                  std::sin(t) * ellipse.minor));
        }
    }

    void addSpline(const DxfEntity& entity, DxfSpline spline, const Affine& frame) {
        spend(entity, spline.controls.size());
        for (Point2& control : spline.controls) control = frame * control;
        Polygon& points = shape_.path.points;
        points = splinePoints(spline, budget_.left());
        spend(entity, points.size());
        shape_.path.closed = distance(points.front(), points.back()) <= kCornerTolerance;
        if (shape_.path.closed) points.pop_back();
    }

    const DxfDrawing& drawing_;
    const std::string& name_;
    Budget budget_;
    LayerSorter& layers_;
    MissingBlocks& missing_;
    std::vector<const std::string*> blocks_;  // around the entity, the outermost first
    std::unordered_map<std::string, Called> called_;
    std::vector<UnreadThing> unread_;
    std::vector<WideFill> fills_;
    Hatches hatches_ = Hatches::OfWalls;
    std::vector<PlanShape> shapes_;
    PlanShape shape_;  // in the making
};

/// Returns the unit of --units, else the one that the drawing states; null if there is none.
const LengthUnit* unitOf(const DxfDrawing& drawing, const ImportOptions& options) {
    const auto unit =
        std::find_if(kLengthUnits.begin(), kLengthUnits.end(), [&](const LengthUnit& u) {
            return options.units.empty() ? u.insunits == drawing.units : u.name == options.units;
        });
    return unit == kLengthUnits.end() ? nullptr : &*unit;
}

/// Returns the codes of $INSUNITS that are read: "1 (inch), 2 (foot) or 4 (mm)".
std::string codesText() {
    std::map<int, std::string> units;
    for (const LengthUnit& unit : kLengthUnits) units[unit.insunits] = unit.name;
    std::string text;
    std::size_t listed = 0;
    for (const auto& [code, unit] : units) {
        if (listed++ > 0) text += listed == units.size() ? " or " : ", ";
        text += std::to_string(code) + " (" + unit + ')';
    }
    return text;
}

std::string unknownUnitText(const DxfDrawing& drawing) {
    return drawing.units == 0
               ? std::string("the drawing does not say its unit ($INSUNITS)")
               : "$INSUNITS is " + std::to_string(drawing.units) + ", wanted " + codesText();
}

/// A drawing's document in a unit, and its room.
struct DxfImport {
    Document document;
    PlanOutcome outcome;
};

class DxfImporter {
  public:
    DxfImporter(const DxfDrawing& drawing, const std::string& name, std::size_t bytes,
                const Schemas& schemas)
        : drawing_(drawing), name_(name), bytes_(bytes), schemas_(schemas) {}

    /// Decides on a unit by the drawing's contents if neither the options nor the drawing state a
    /// likely one.
    void decideUnit(const ImportOptions& options) {
        if (!options.units.empty() || options.width_is || isDrawnRoom(drawing_)) return;
        const LengthUnit* const stated = unitOf(drawing_, options);
        decided_ = decidedUnit(rankingOf(options, stated), stated);
    }

    /// Returns the likely units of the drawing, computed once.
    const std::vector<UnitEvidence>& rankingOf(const ImportOptions& options,
                                               const LengthUnit* stated) const {
        if (ranking_) return *ranking_;
        Budget reading(bytes_, options.max_work);
        const auto read = [&](double metres) -> LayerSorter::Sorted {
            try {
                MissingBlocks missing;
                LayerSorter sorter(drawing_.hidden_layers, options);
                WorkLimit limit = options.max_work;
                limit.whole = &reading;
                std::vector<PlanShape> shapes =
                    Expander(drawing_, name_, Budget(bytes_, limit), missing, sorter)
                        .expand(metres, Hatches::All);
                leaveOutStrays(shapes);
                return sorter.sort(std::move(shapes));
            } catch (const FormatError& /*not to be read*/) {
                return {};
            }
        };
        return ranking_.emplace(
            rankedUnits(read, Budget(bytes_, options.max_work), stated, usualUnits()));
    }

    /// \param hints whether the drawing may be imported again to report the effect of other options
    /// \param better_layers see DrawingSource
    [[nodiscard]] DxfImport import(const ImportOptions& asked, bool hints,
                                   std::vector<std::string>* better_layers = nullptr) const {
        Budget whole(bytes_, asked.max_work);
        ImportOptions options = asked;
        options.max_work.whole = &whole;  // pays for curves and blocks, and for the plan of them
        ImportRecords out(schemas_, name_, options);
        DrawingSource source = scaleOf(options, out);
        source.left_out = drawing_.left_out;
        source.ranking = [&]() -> const std::vector<UnitEvidence>& {
            return rankingOf(asked, nullptr);
        };
        Budget again(bytes_, asked.max_work);  // for all hints
        if (hints)
            source.import = [&](ImportOptions other) {
                other.max_work = {asked.max_work.max, &again};
                return import(other, false).outcome;
            };
        source.better_layers = better_layers;
        MissingBlocks missing;
        const bool is_ours = options.wall_layers.empty() && options.door_layers.empty() &&
                             options.window_layers.empty() && isDrawnRoom(drawing_);
        ImportOptions own = is_ours ? asDrawn(options) : options;
        LayerSorter sorter(drawing_.hidden_layers, own);
        Expander expander(drawing_, name_, Budget(bytes_, options.max_work), missing, sorter);
        std::vector<PlanShape> expanded = expander.expand(source.metres_per_unit);
        if (!is_ours) leaveOutStrays(expanded, &out);
        const auto moved = expander.moveHome(expanded);
        if (moved) out.report(surveyText(*moved, "drawing"));
        const double metres = source.metres_per_unit;
        const Affine frame{{metres, 0}, {0, metres}, -1 * moved.value_or(Vec2())};
        LayerSorter::Sorted shapes = sorter.sort(std::move(expanded));
        sorter.note(out);
        if (!drawing_.left_out.empty())
            out.note("entities left out: " + listText(drawing_.left_out));
        if (!missing.empty())
            out.note("inserts of blocks that the file lacks: " + listText(missing));
        if (is_ours) {
            out.note("a room as envc draws it");
            if (own.inside.empty() && own.known_inside.empty() && own.rooms == RoomChoice::Largest)
                own.inside = drawnInside(drawing_, frame);
            shapes.sizes.emplace();
            for (const auto& [line, size] : drawing_.sizes)
                (*shapes.sizes)[line] = {metres * size.width,  metres * size.bottom,
                                         metres * size.height, metres * size.depth,
                                         size.glass,           size.is_open,
                                         size.is_blind};
        }
        const std::optional<std::map<int, DrawnSize>> sizes = shapes.sizes;
        if (sizes) addRaisedWalls(shapes.walls, *sizes, out);
        std::vector<Segment2> lines;
        if (!expander.wideFills().empty()) lines = pathPieces(shapes.walls);
        const PlanOutcome outcome =
            writeLinePlan(std::move(shapes), sorter, name_, own, is_ours ? nullptr : &source, out);
        if (sizes) addDrawnThings(drawing_, *sizes, frame, out);
        std::vector<UnreadThing> unread = expander.unread();
        Budget looking(bytes_, {asked.max_work.max, &again});
        withFileName(name_, [&] {
            addWideFills(expander.wideFills(), outcome.rooms, lines, looking, unread);
        });
        warnOfUnread(unread, outcome.rooms,
                     "explode it, or bind the reference, in the program that drew it, and export "
                     "lines; --wall-layer names the layers that count",
                     out);
        return {out.take(), outcome};
    }

  private:
    /// Returns options for a drawing of writeDxf(): its layers, and lines that already meet.
    static ImportOptions asDrawn(ImportOptions options) {
        options.wall_layers = {"walls"};
        options.door_layers = {"doors"};
        options.window_layers = {"windows"};
        if (!options.snap) options.snap = 0;
        return options;
    }

    [[nodiscard]] DrawingSource scaleOf(const ImportOptions& options, ImportRecords& out) const {
        if (!options.width_is) {
            const LengthUnit* unit = unitOf(drawing_, options);
            if (options.units.empty() && decided_ != nullptr) {
                warnOfDecision(unit, out);
                unit = decided_->unit;
            } else if (unit != nullptr) {
                out.note(std::string("unit: ") + unit->name +
                         (options.units.empty() ? ", as $INSUNITS of the drawing says"
                                                : ", as asked for"));
            } else {
                failFile(name_,
                         options.units.empty()
                             ? unknownUnitText(drawing_) + scaleHint(rankingOf(options, nullptr))
                             : "unknown unit " + options.units + ": " + kScaleHint);
            }
            return {unit->name, unit->metres, bytes_};
        }
        const double metres = metresPerUnit(*options.width_is, name_, [&](double metres_per_unit) {
            MissingBlocks missing;
            LayerSorter sorter(drawing_.hidden_layers, options);
            LayerSorter::Sorted sorted = sorter.sort(
                Expander(drawing_, name_, Budget(bytes_, options.max_work), missing, sorter)
                    .expand(metres_per_unit));
            sorter.mustHaveWalls(sorted, name_, drawing_.left_out);
            return std::move(sorted.walls);
        });
        out.note(unitText(metres) + ", so that it is " + formatDouble(*options.width_is) +
                 " m wide");
        return {unitText(metres), metres, bytes_};
    }

    void warnOfDecision(const LengthUnit* stated, ImportRecords& out) const {
        const std::string reason =
            std::string(decided_->unit->name) + ", in which " + evidenceText(*decided_);
        if (stated == nullptr)
            out.warn(unknownUnitText(drawing_) + ": it is read in " + reason +
                     "; --units takes another");
        else
            out.warn(std::string("the drawing states ") + stated->name +
                     " ($INSUNITS), but is read in " + reason + "; --units takes another");
    }

    const DxfDrawing& drawing_;
    const std::string& name_;
    std::size_t bytes_;  // of the file
    mutable std::optional<std::vector<UnitEvidence>> ranking_;
    const UnitEvidence* decided_ = nullptr;  // the first of them, instead of the stated unit
    const Schemas& schemas_;
};

}  // namespace

Document readDxf(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas) {
    const DxfDrawing drawing = readDrawing(bytes, name);
    DxfImporter importer(drawing, name, bytes.size(), schemas);
    importer.decideUnit(options);
    return importWithNamedWalls(
        options, [&](const ImportOptions& asked, std::vector<std::string>* better_layers) {
            return importer.import(asked, true, better_layers).document;
        });
}

}  // namespace ispace::cad
