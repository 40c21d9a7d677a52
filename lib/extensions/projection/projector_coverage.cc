// SPDX-License-Identifier: GPL-3.0-or-later
// The picture is a pinhole's, without distortion: pixel (f y / x, g z / x) for a point (x, y, z)
// before the lens. Its derivative by two unit vectors of a plane is a 2 x 2 matrix (a, b; c, d);
// its singular values are the densities: half the sum and difference of hypot(a + d, b - c) and
// hypot(a - d, b + c).
//
// A pose that shows a point at (across, upright) of the picture follows in closed form from the
// tilt, which the height of the direction decides alone (anglesTowards()). Cells with a bound, by
// the densest corner of the picture, that is too small are only asked whether any pose lights them.
// The largest rectangle is that of the histogram, O(cells) a pose; the search over poses is a grid
// and then a descent to 0.1 degrees, a heuristic.
#include "extensions/projection/projector_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "env/projector_beam.h"
#include "sense/selection.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace::projection {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kNearest = 0.01;        // metres before the lens
constexpr double kLeastDistance = 1e-4;  // metres from the lens to a plane that it lights

double turnedInto(double degrees) {
    const double turn = 360;
    double rest = std::remainder(degrees, turn);
    if (rest <= -turn / 2) rest += turn;
    return rest;
}

/// A projector of the scene.
struct Source {
    const Record* record = nullptr;
    ProjectorModel model;
    Point3 lens;
    Angle heading;
    TurnedAngles now;

    [[nodiscard]] SurfacePicture turned(const TurnedAngles& angles) const {
        // As projectorLens() of the record.
        return {model,
                Frame3(Pose3{
                    lens, heading + Angle::degrees(angles.pan), Angle::degrees(angles.tilt), {}})};
    }
    [[nodiscard]] TurnedAngles within(TurnedAngles angles) const {
        return {std::clamp(angles.pan, model.pan.least, model.pan.most),
                std::clamp(angles.tilt, model.tilt.least, model.tilt.most)};
    }
};

/// Returns the most pixels of a picture in a radian about the lens: those of a corner, where the
/// picture is farthest from the axis.
double pixelsPerRadian(const ProjectorModel& model) {
    const double across = model.columns / (2 * model.across),
                 upright = model.rows / (2 * model.upright);
    return std::max(across, upright) *
           (1 + model.across * model.across + model.upright * model.upright);
}

/// The cells of a facet as a projector meets them.
struct FacetView {
    const FlatFace* facet = nullptr;
    std::vector<char> faces = {};     // of FlatFace::cells: the lens is before the plane
    std::vector<char> is_free = {};   // no element between
    std::vector<char> is_clear = {};  // and no mover
    std::vector<double> best = {};    // density in the best pose
};

/// Computes which cells of a facet the light of a lens reaches.
FacetView viewOf(const FlatFace& facet, Point3 lens, const RayWorld& world,
                 const MovingBodies& movers) {
    FacetView view{&facet};
    const std::size_t count = facet.cells.size();
    view.faces.assign(count, 0);
    view.is_free.assign(count, 0);
    view.is_clear.assign(count, 0);
    if (dot(facet.frame.forward, lens - facet.frame.origin) <= kLeastDistance) return view;
    std::vector<Point3> places;
    places.reserve(count);
    for (const std::size_t cell : facet.cells) places.push_back(facet.middleOf(cell));
    std::vector<std::uint8_t> free(count, 0);
    world.query(lens, places, free);
    for (std::size_t i = 0; i < count; ++i) {
        view.faces[i] = 1;
        view.is_free[i] = free[i] != 0 ? 1 : 0;
        if (free[i] == 0 || movers.between(lens, places[i], MovingBodies::kNoOwner)) continue;
        view.is_clear[i] = 1;
    }
    return view;
}

/// The poses of a projector in which it may show a point well.
class BestPoses {
  public:
    BestPoses(const Source& source, const FlatFace& facet) : source_(source), facet_(facet) {
        if (!source.model.turns()) {
            fixed_.push_back(source.turned(source.now));
            return;
        }
        most_ = pixelsPerRadian(source.model);
        // The one that faces the surface.
        if (const auto angles = anglesTowards(-1.0 * facet.frame.forward, 0, 0, source.heading))
            fixed_.push_back(source.turned(source.within(*angles)));
    }

    /// Returns an upper bound of densityAt(). Along the way to the foot of the lens a metre of the
    /// plane has cos(incidence) / distance radians, as seen from the lens.
    [[nodiscard]] double boundAt(Point3 place) const {
        constexpr double kRounding = 1 + 1e-9;
        if (!source_.model.turns()) return std::numeric_limits<double>::infinity();
        const Vec3 way = source_.lens - place;
        return kRounding * most_ * std::abs(dot(facet_.frame.forward, way)) / dot(way, way);
    }

    /// Returns the largest least density at a point, 0 if no pose shows it; or any that is not,
    /// once it is above `enough`.
    [[nodiscard]] double densityAt(Point3 place,
                                   double enough = std::numeric_limits<double>::infinity()) const {
        double best = 0;
        const auto take = [&](const SurfacePicture& picture) {
            if (const auto density = picture.at(place, facet_.frame.left, facet_.frame.up))
                best = std::max(best, density->least);
        };
        for (const SurfacePicture& picture : fixed_) take(picture);
        if (!source_.model.turns() || best > enough) return best;
        constexpr std::array<double, 5> kPositions = {-1, -0.5, 0, 0.5, 1};
        // A little within the picture, against rounding.
        constexpr double kInside = 1 - 1e-9;
        const Vec3 way = place - source_.lens;
        for (const double upright : kPositions)
            for (const double across : kPositions) {
                const auto angles =
                    anglesTowards(way, kInside * across * source_.model.across,
                                  kInside * upright * source_.model.upright, source_.heading);
                if (angles) take(source_.turned(source_.within(*angles)));
                if (best > enough) return best;
            }
        return best;
    }

  private:
    const Source& source_;
    const FlatFace& facet_;
    std::vector<SurfacePicture> fixed_;
    double most_ = 0;  ///< see pixelsPerRadian()
};

/// Computes the densities of the cells before a lens, `best` of all clear cells of the surface so
/// far. Of cells that no pose lights with `density`, and that cannot raise `best`, it only finds
/// whether one lights them at all: their densities may be too small.
void findDensities(const BestPoses& poses, double density, FacetView& view, double& best) {
    const FlatFace& facet = *view.facet;
    view.best.assign(facet.cells.size(), 0);
    std::vector<double> bounds(facet.cells.size(), 0);
    std::optional<std::size_t> first;  // the one that is likely to have the largest
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        if (view.faces[i] == 0) continue;
        bounds[i] = poses.boundAt(facet.middleOf(facet.cells[i]));
        if (view.is_clear[i] != 0 && (!first || bounds[i] > bounds[*first])) first = i;
    }
    const auto find = [&](std::size_t i) {
        const bool is_weak = bounds[i] < density && (bounds[i] <= best || view.is_clear[i] == 0);
        const Point3 place = facet.middleOf(facet.cells[i]);
        view.best[i] = is_weak ? poses.densityAt(place, 0) : poses.densityAt(place);
        if (view.is_clear[i] != 0) best = std::max(best, view.best[i]);
    };
    if (first) find(*first);
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if (view.faces[i] != 0) find(i);
}

/// Searches the pose with the largest rectangle on a facet.
class RectangleSearch {
  public:
    RectangleSearch(const Source& source, const FacetView& view, double density)
        : source_(source), view_(view), facet_(*view.facet), density_(density) {
        std::size_t last_column = 0, last_row = 0;
        for (std::size_t i = 0; i < facet_.cells.size(); ++i) {
            if (view_.is_clear[i] == 0) continue;
            const std::size_t cell = facet_.cells[i];
            lit_.add(onFacet(facet_.middleOf(cell)));
            if (view_.best[i] < density_) continue;
            if (cells_.empty()) {
                first_row_ = cell / facet_.columns;
                first_column_ = facet_.columns;
            }
            cells_.push_back(cell);
            places_.push_back(facet_.middleOf(cell));
            first_column_ = std::min(first_column_, cell % facet_.columns);
            last_column = std::max(last_column, cell % facet_.columns);
            last_row = cell / facet_.columns;
        }
        if (cells_.empty()) return;
        columns_ = last_column - first_column_ + 1;
        marks_.assign(columns_ * (last_row - first_row_ + 1), 0);
        for (std::size_t& cell : cells_)
            cell = (cell / facet_.columns - first_row_) * columns_ + cell % facet_.columns -
                   first_column_;
    }

    [[nodiscard]] std::optional<PictureRectangle> find() {
        if (cells_.empty()) return std::nullopt;
        if (!source_.model.turns()) {
            consider(source_.now);
        } else {
            for (const TurnedAngles& angles : towardsGrid()) consider(angles);
            if (!(best_.area > 0)) return std::nullopt;
            refine();
        }
        if (!(best_.area > 0)) return std::nullopt;
        return measured();
    }

  private:
    struct Choice {
        CellRectangle cells;
        Box2 box;
        double area = 0;
        TurnedAngles angles;
        double facing = -1;  // cosine of the slant
    };

    /// Returns the poses towards a grid of points that spans the lit cells and the foot of the lens
    /// on the plane, as far as it is near them.
    [[nodiscard]] std::vector<TurnedAngles> towardsGrid() const {
        constexpr double kStep = 0.25;
        Box2 box = lit_;
        const Point2 foot = onFacet(source_.lens);
        const double reach = std::max(box.width(), box.depth());
        const Box2 near = box.expanded(reach);
        box.add({std::clamp(foot.x, near.low.x, near.high.x),
                 std::clamp(foot.y, near.low.y, near.high.y)});
        const auto count = [](double size) {
            constexpr int kMost = 20;
            return std::clamp(static_cast<int>(std::ceil(size / kStep)), 1, kMost);
        };
        const int columns = count(box.width()), rows = count(box.depth());
        std::vector<TurnedAngles> out;
        const auto add = [&](Point3 place) {
            if (const auto angles = anglesTowards(place - source_.lens, 0, 0, source_.heading))
                out.push_back(source_.within(*angles));
        };
        out.reserve(static_cast<std::size_t>((columns + 1) * (rows + 1)) + 2);
        out.push_back(source_.within(source_.now));
        if (const auto angles = anglesTowards(-1.0 * facet_.frame.forward, 0, 0, source_.heading))
            out.push_back(source_.within(*angles));
        for (int row = 0; row <= rows; ++row)
            for (int column = 0; column <= columns; ++column)
                add(facet_.at(box.low.x + box.width() * column / columns,
                              box.low.y + box.depth() * row / rows));
        return out;
    }

    [[nodiscard]] Point2 onFacet(Point3 place) const {
        const Vec3 way = place - facet_.frame.origin;
        return {-dot(way, facet_.frame.left), dot(way, facet_.frame.up)};
    }

    void consider(const TurnedAngles& angles) {
        const SurfacePicture picture = source_.turned(angles);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const auto density = picture.at(places_[i], facet_.frame.left, facet_.frame.up);
            marks_[cells_[i]] = density && density->least >= density_ ? 1 : 0;
        }
        CellRectangle found = largestRectangle(marks_, columns_);
        found.column += first_column_;
        found.row += first_row_;
        const double most =
            static_cast<double>(found.size()) * facet_.cellWidth() * facet_.cellHeight();
        if (found.size() == 0 || most < best_.area) return;
        const Box2 box = grown(found, picture);
        const double area = box.width() * box.depth();
        const double facing = -dot(picture.lens().forward, facet_.frame.forward);
        if (area > best_.area || (area == best_.area && facing > best_.facing))
            best_ = {found, box, area, angles, facing};
    }

    /// Tries the poses around the best one, in smaller and smaller steps.
    void refine() {
        constexpr double kFirst = 3.2, kLast = 0.1;  // degrees
        constexpr std::array<std::array<double, 2>, 8> kAround = {
            {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};
        for (double step = kFirst; step >= kLast; step /= 2) {
            const TurnedAngles middle = best_.angles;
            for (const auto& [pan, tilt] : kAround)
                consider(source_.within(
                    {turnedInto(middle.pan + step * pan), middle.tilt + step * tilt}));
        }
    }

    /// Returns true if light reaches these cells; cells beyond the surface, whose edge is between,
    /// do not matter.
    [[nodiscard]] bool areClear(std::size_t column, std::size_t columns, std::size_t row,
                                std::size_t rows) const {
        if (column >= facet_.columns || row >= facet_.rows) return true;  // also -1
        for (std::size_t r = row; r < row + rows; ++r)
            for (std::size_t c = column; c < column + columns; ++c) {
                const std::size_t cell = r * facet_.columns + c;
                const auto found = std::lower_bound(facet_.cells.begin(), facet_.cells.end(), cell);
                if (found == facet_.cells.end() || *found != cell ||
                    view_.is_clear[static_cast<std::size_t>(found - facet_.cells.begin())] == 0)
                    return false;
            }
        return true;
    }

    /// Returns true if a picture lights a line of the surface with the density.
    [[nodiscard]] bool lights(const SurfacePicture& picture, Point2 a, Point2 b,
                              std::size_t steps) const {
        for (std::size_t i = 0; i <= steps; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(steps);
            const Point2 on = a + share * (b - a);
            const auto density =
                picture.at(facet_.at(on.x, on.y), facet_.frame.left, facet_.frame.up);
            if (!density || density->least < density_) return false;
        }
        return true;
    }

    /// Returns the rectangle of the middles of cells, which are what has been looked at, grown to
    /// the edge of the cells on each side that the picture lights, too.
    [[nodiscard]] Box2 grown(const CellRectangle& cells, const SurfacePicture& picture) const {
        const double wide = facet_.cellWidth(), high = facet_.cellHeight();
        const std::size_t right = cells.column + cells.columns, upper = cells.row + cells.rows;
        const auto edge = [](std::size_t cell, double size) {
            return static_cast<double>(cell) * size;
        };
        Box2 box;
        box.add({edge(cells.column, wide) + wide / 2, edge(cells.row, high) + high / 2});
        box.add({edge(right, wide) - wide / 2, edge(upper, high) - high / 2});
        for (const auto& [beside, at] : {std::pair{cells.column - 1, cells.column}, {right, right}})
            if (const double x = edge(at, wide);
                areClear(beside, 1, cells.row, cells.rows) &&
                lights(picture, {x, box.low.y}, {x, box.high.y}, cells.rows))
                box.add({x, box.low.y});
        for (const auto& [beside, at] : {std::pair{cells.row - 1, cells.row}, {upper, upper}})
            if (const double y = edge(at, high);
                areClear(cells.column, cells.columns, beside, 1) &&
                lights(picture, {box.low.x, y}, {box.high.x, y}, cells.columns))
                box.add({box.low.x, y});
        return box;
    }

    [[nodiscard]] PictureRectangle measured() const {
        const auto& [cells, box, area, angles, facing] = best_;
        PictureRectangle out;
        const SurfacePicture picture = source_.turned(angles);
        out.left = box.low.x;
        out.bottom = box.low.y;
        out.width = box.width();
        out.height = box.depth();
        out.middle = facet_.at(out.left + out.width / 2, out.bottom + out.height / 2);
        out.pan = Angle::degrees(angles.pan);
        out.tilt = Angle::degrees(angles.tilt);
        out.slant = Angle::degrees(std::acos(std::clamp(facing, -1.0, 1.0)) * kDegrees);
        const ProjectorBeam beam{picture.lens(), source_.model.across, source_.model.upright,
                                 source_.model.lumens};
        bool is_first = true;
        for (std::size_t row = cells.row; row < cells.row + cells.rows; ++row)
            for (std::size_t column = cells.column; column < cells.column + cells.columns;
                 ++column) {
                const Point3 place = facet_.middleOf(row * facet_.columns + column);
                const auto density = picture.at(place, facet_.frame.left, facet_.frame.up);
                const auto spot = beam.spotAt(place, facet_.frame.forward);
                if (!density || !spot) continue;
                out.least = is_first ? density->least : std::min(out.least, density->least);
                out.most = std::max(out.most, density->most);
                out.lux = is_first ? spot->lux : std::min(out.lux, spot->lux);
                is_first = false;
            }
        return out;
    }

    const Source& source_;
    const FacetView& view_;
    const FlatFace& facet_;
    double density_;
    Box2 lit_;                    ///< of the clear cells
    std::vector<Point3> places_;  ///< of cells that are clear and have the density in some pose
    std::size_t first_column_ = 0, first_row_ = 0, columns_ = 0;  ///< of the window about these
    std::vector<std::size_t> cells_;                              ///< their places in the window
    std::vector<char> marks_;                                     ///< of the window
    Choice best_;
};

/// Measures how a projector covers a surface; empty if no light reaches it.
std::optional<SurfaceProjection> coveredSurface(const Source& source,
                                                const ProjectionSurface& surface, double density,
                                                const RayWorld& world, const MovingBodies& movers) {
    std::vector<FacetView> views;
    views.reserve(surface.facets.size());
    std::size_t free = 0;
    for (const FlatFace& facet : surface.facets) {
        views.push_back(viewOf(facet, source.lens, world, movers));
        free += static_cast<std::size_t>(
            std::count(views.back().is_free.begin(), views.back().is_free.end(), 1));
    }
    if (free == 0) return std::nullopt;
    SurfaceProjection out;
    for (FacetView& view : views) {
        const FlatFace& facet = *view.facet;
        const BestPoses poses(source, facet);
        findDensities(poses, density, view, out.best);
        std::vector<CellState> states(facet.cells.size(), CellState::Dark);
        for (std::size_t i = 0; i < facet.cells.size(); ++i) {
            if (view.faces[i] == 0) continue;
            const bool is_fine = view.best[i] >= density;
            if (view.is_clear[i] != 0 && view.best[i] > 0)
                states[i] = is_fine ? CellState::Carries : CellState::Coarse;
            else if (is_fine)
                states[i] =
                    view.is_free[i] != 0 ? CellState::ShadowedByMovers : CellState::Shadowed;
            if (!is_fine) continue;
            double& part = states[i] == CellState::Carries    ? out.carries
                           : states[i] == CellState::Shadowed ? out.shadowed
                                                              : out.shadowed_by_movers;
            part += facet.cellArea();
        }
        out.cells.push_back(std::move(states));
    }
    if (out.best == 0) return std::nullopt;
    if (surface.isFlat() && out.carries > 0)
        out.rectangle = RectangleSearch(source, views.front(), density).find();
    return out;
}

std::vector<Source> sourcesOf(const Scene& scene, std::vector<std::string>& ids) {
    std::vector<Source> sources;
    for (const Element& element : scene.environment.elements()) {
        const Record& record = element.record;
        if (record.keyword() != "projector") continue;
        ids.push_back(element.id);
        sources.push_back({&record,
                           projectorModel(record),
                           projectorLens(record, {}, {}).origin,
                           record.angle("heading"),
                           {record.number("pan"), record.number("tilt")}});
    }
    return sources;
}

void addCarried(ProjectionReport& out) {
    out.carried.assign(out.surfaces.size(), 0);
    for (std::size_t s = 0; s < out.surfaces.size(); ++s) {
        const ProjectionSurface& surface = out.surfaces[s];
        for (std::size_t f = 0; f < surface.facets.size(); ++f) {
            std::vector<char> any(surface.facets[f].cells.size(), 0);
            for (const ProjectorCoverage& projector : out.projectors)
                for (const SurfaceProjection& one : projector.surfaces)
                    if (one.surface == s)
                        for (std::size_t i = 0; i < any.size(); ++i)
                            if (one.cells[f][i] == CellState::Carries) any[i] = 1;
            out.carried[s] += surface.facets[f].cellArea() *
                              static_cast<double>(std::count(any.begin(), any.end(), 1));
        }
    }
}

}  // namespace

std::optional<PictureDensity> SurfacePicture::at(Point3 place, Vec3 along, Vec3 across) const {
    const Vec3 local = lens_.toLocal(place);
    if (local.x < kNearest) return std::nullopt;
    if (!(std::abs(local.y) <= model_->across * local.x &&
          std::abs(local.z) <= model_->upright * local.x))
        return std::nullopt;
    const auto turned = [this](Vec3 v) {
        return Vec3{dot(v, lens_.forward), dot(v, lens_.left), dot(v, lens_.up)};
    };
    const Vec3 s = turned(along), t = turned(across);
    // The pixel is (u, v) = (f y / x, g z / x), with f and g in pixels.
    const double f = model_->columns / (2 * model_->across);
    const double g = model_->rows / (2 * model_->upright);
    const double square = local.x * local.x;
    const double a = f * (s.y * local.x - local.y * s.x) / square;
    const double b = f * (t.y * local.x - local.y * t.x) / square;
    const double c = g * (s.z * local.x - local.z * s.x) / square;
    const double d = g * (t.z * local.x - local.z * t.x) / square;
    const double sum = std::hypot(a + d, b - c), difference = std::hypot(a - d, b + c);
    return PictureDensity{std::abs(sum - difference) / 2, (sum + difference) / 2};
}

std::optional<TurnedAngles> anglesTowards(Vec3 direction, double across, double upright,
                                          Angle heading) {
    const double size = length(direction);
    const double sine = direction.z / size * std::sqrt(1 + across * across + upright * upright) /
                        std::sqrt(1 + upright * upright);
    constexpr double kSlack = 1e-12;
    if (!(std::abs(sine) <= 1 + kSlack)) return std::nullopt;
    const double tilt = std::asin(std::clamp(sine, -1.0, 1.0)) - std::atan(upright);
    constexpr double kQuarter = 90;
    if (std::abs(tilt) * kDegrees > kQuarter + kSlack) return std::nullopt;
    // Where the position lies from above, seen along the axis.
    const double ahead = std::cos(tilt) - upright * std::sin(tilt);
    const double bearing = std::atan2(across, ahead);
    const double azimuth = direction.x == 0 && direction.y == 0
                               ? heading.radians() + bearing
                               : std::atan2(direction.y, direction.x);
    return TurnedAngles{turnedInto((azimuth - bearing) * kDegrees - heading.degrees()),
                        std::clamp(tilt * kDegrees, -kQuarter, kQuarter)};
}

CellRectangle largestRectangle(const std::vector<char>& cells, std::size_t columns) {
    // Each row is the base line of a histogram of true cells above each other; the stack holds the
    // columns at which bars rise.
    CellRectangle best;
    if (columns == 0) return best;
    std::vector<std::size_t> heights(columns + 1, 0), rising;
    for (std::size_t row = 0; row < cells.size() / columns; ++row) {
        for (std::size_t i = 0; i < columns; ++i)
            heights[i] = cells[row * columns + i] != 0 ? heights[i] + 1 : 0;
        rising.clear();
        for (std::size_t i = 0; i <= columns; ++i) {
            while (!rising.empty() && heights[rising.back()] >= heights[i]) {
                const std::size_t high = heights[rising.back()];
                rising.pop_back();
                const std::size_t left = rising.empty() ? 0 : rising.back() + 1;
                if (high * (i - left) > best.size()) best = {left, row + 1 - high, i - left, high};
            }
            rising.push_back(i);
        }
    }
    return best;
}

double projectionCell(const Environment& environment) {
    constexpr double kUsual = 0.05, kCells = 1e6;
    const Box2& box = environment.limits();
    return std::max(kUsual, std::sqrt(box.width() * box.depth() / kCells));
}

ProjectionReport projectionOf(const Scene& scene, double density, double cell) {
    ProjectionReport out;
    out.density = density;
    out.cell = cell;
    out.surfaces = projectionSurfaces(scene.environment, cell);
    std::vector<std::string> ids;
    const std::vector<Source> sources = sourcesOf(scene, ids);
    const RayWorld world = RayWorld::ofEnvironment(scene.environment);
    const MovingBodies movers(bodiesOf(scene));
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Source& source = sources[i];
        ProjectorCoverage projector;
        projector.id = ids[i];
        if (source.record->has("model")) projector.model = source.record->text("model");
        projector.figures = source.model;
        for (std::size_t s = 0; s < out.surfaces.size(); ++s) {
            auto covered = coveredSurface(source, out.surfaces[s], density, world, movers);
            if (!covered) continue;
            covered->surface = s;
            projector.carries += covered->carries;
            projector.surfaces.push_back(std::move(*covered));
        }
        out.projectors.push_back(std::move(projector));
    }
    addCarried(out);
    return out;
}

}  // namespace ispace::projection
