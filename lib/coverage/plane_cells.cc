// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/plane_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "sense/scan.h"

namespace ispace {

namespace {

/// Number of views tested together, one for each bit of a word.
constexpr std::size_t kTogether = 64;

/// The part of a plane that may be in view.
struct Reach {
    Point3 origin;
    double distance = 0;  ///< maximum distance of a point in view, on the plan

    /// Empty if the plane, `drop` above or below, is out of range.
    static std::optional<Reach> of(Point3 origin, double range, double drop) {
        constexpr double kSlack = 1 + 1e-6;  // ranges are compared as float32
        if (!withinRange(std::fabs(drop), range)) return std::nullopt;
        return Reach{origin, kSlack * std::sqrt(std::max(0.0, range * range - drop * drop))};
    }
};

/// The target of a cell's ray, and the views that contain it.
struct CellTarget {
    Point3 place;
    std::uint64_t held = 0;  ///< bit k: in view k
};

/// Tests the cells row by row. `target_of(center)` returns the CellTarget of a cell.
template <typename TargetOf>
class RowLook {
  public:
    RowLook(const Grid& grid, const RayWorld& mesh, const Reach& reach, const TargetOf& target_of,
            const CellWindow& window)
        : grid_(grid),
          columns_(GridAxis::columnsOf(grid)),
          mesh_(mesh),
          reach_(reach),
          target_of_(target_of),
          window_(window) {}

    /// Appends the cells of a row that each view sees to its runs.
    void add(int row, std::span<std::vector<CellRun>> runs) {
        findTargets(row);
        if (targets_.empty()) return;
        seen_.resize(targets_.size());
        mesh_.query(reach_.origin, targets_, seen_);
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (seen_[i] == 0 && targets_[i] != reach_.origin) continue;
            for (std::uint64_t bits = held_[i]; bits != 0; bits &= bits - 1)
                addCell(runs[static_cast<std::size_t>(std::countr_zero(bits))], cells_[i]);
        }
    }

  private:
    /// Finds the cells of the row that lie in any view.
    void findTargets(int row) {
        cells_.clear();
        targets_.clear();
        held_.clear();
        const double y = grid_.rowCenter(row), dy = y - reach_.origin.y;
        if (!(std::fabs(dy) <= reach_.distance)) return;
        const double half = std::sqrt(reach_.distance * reach_.distance - dy * dy);
        const int in_reach = columns_.firstNotBelow(reach_.origin.x - half);
        const int first = std::max(in_reach, window_.first_column);
        const int end =
            std::min(columns_.firstAbove(reach_.origin.x + half, in_reach), window_.end_column);
        for (int column = first; column < end; ++column) {
            const CellTarget target = target_of_(Point2{grid_.columnCenter(column), y});
            if (target.held == 0) continue;
            cells_.push_back(static_cast<std::uint32_t>(grid_.cell(column, row)));
            targets_.push_back(target.place);
            held_.push_back(target.held);
        }
    }
    static void addCell(std::vector<CellRun>& runs, std::uint32_t cell) {
        if (!runs.empty() && runs.back().end == cell)
            ++runs.back().end;
        else
            runs.push_back({cell, cell + 1});
    }

    const Grid& grid_;
    GridAxis columns_;
    const RayWorld& mesh_;
    Reach reach_;
    const TargetOf& target_of_;
    CellWindow window_;
    std::vector<std::uint32_t> cells_;
    std::vector<Point3> targets_;
    std::vector<std::uint64_t> held_;
    std::vector<std::uint8_t> seen_;
};

/// Appends a part for each view. Bands of rows run in parallel.
template <typename TargetOf>
void addParts(const Grid& grid, const RayWorld& mesh, const Reach& reach, std::size_t views,
              const TargetOf& target_of, CellParts& parts, const CellWindow& window = {}) {
    constexpr int kCellsOfBand = 1 << 16;
    const int rows = std::max(1, kCellsOfBand / grid.columns);
    const auto bands = static_cast<std::size_t>((grid.rows + rows - 1) / rows);
    std::vector<std::vector<std::vector<CellRun>>> runs(bands);
    const auto look = [&](std::size_t band) {
        runs[band].resize(views);
        RowLook<TargetOf> row_look(grid, mesh, reach, target_of, window);
        const int first = static_cast<int>(band) * rows;
        for (int row = std::max(first, window.first_row);
             row < std::min({first + rows, grid.rows, window.end_row}); ++row)
            row_look.add(row, runs[band]);
    };
    if (bands == 1)
        look(0);
    else
        tbb::parallel_for(std::size_t{0}, bands, look);
    for (std::size_t k = 0; k < views; ++k) {
        for (const auto& of_band : runs)
            parts.runs.insert(parts.runs.end(), of_band[k].begin(), of_band[k].end());
        parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
    }
}

/// A laser that scans in one tilted plane covers the floor below or above that plane.
void addScan(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, CellParts& parts) {
    const Point3 origin = sensor.pose.position;
    const Laser& laser = sensor.as<Laser>();
    const ScanPlane plane(sensor.pose);
    const auto reach = Reach::of(origin, laser.max_range, 0);
    if (plane.up() == 0 || !reach) return;  // upright: a line, as seen from above
    const BearingWindow window(laser);
    addParts(
        grid, mesh, *reach, 1,
        [&](Point2 center) {
            const Point3 target{center.x, center.y, plane.heightAt(center)};
            const Vec3 way = target - origin;
            const bool is_held = target.z >= 0 &&
                                 withinRange(std::sqrt(dot(way, way)), laser.max_range) &&
                                 window.holds(plane.frame().toLocal(target));
            return CellTarget{target, is_held ? 1U : 0U};
        },
        parts);
}

void addSweep(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height,
              CellParts& parts) {
    const Point3 origin = sensor.pose.position;
    const double range = sensor.as<Laser>().max_range;
    const auto reach = Reach::of(origin, range, height - origin.z);
    if (!reach) return;
    const SweptScan scan(sensor);
    addParts(
        grid, mesh, *reach, 1,
        [&](Point2 center) {
            const Point3 target{center.x, center.y, height};
            const Vec3 way = target - origin;
            const bool is_held =
                withinRange(std::sqrt(dot(way, way)), range) && scan.passes(target);
            return CellTarget{target, is_held ? 1U : 0U};
        },
        parts);
}

/// Decides for nearly all directions whether they are in the picture of a lens that distorts by the
/// angle to the axis alone, without evaluating the lens model: reads the position in the picture
/// from a table over the cosine of that angle.
class PictureTable {
  public:
    enum class Answer { Outside, Inside, Unsure };

    /// Builds the table. \pre a fisheye or a mirror
    explicit PictureTable(const Camera& camera)
        : low_{(-0.5 - camera.cx) / camera.fx, (-0.5 - camera.cy) / camera.fy},
          high_{(camera.columns - 0.5 - camera.cx) / camera.fx,
                (camera.rows - 0.5 - camera.cy) / camera.fy} {
        const Angle widest = camera.widestInPicture();
        has_all_ = widest <= kLimit;
        // Slightly less, as the lens may end there.
        least_ = cos(std::min(widest, kLimit) - Angle::radians(kRounding / 10));
        step_ = (1 - least_) / kSteps;
        for (int i = 0; i <= kSteps; ++i)
            stretch_[static_cast<std::size_t>(i)] = stretchAt(camera, least_ + i * step_);
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = least_ + (i + 0.5) * step_;
            margin_ = std::max(margin_, std::fabs(stretchOf(cosine) - stretchAt(camera, cosine)));
        }
        margin_ = kSafety * margin_ + kRounding;
    }

    /// Finds the direction in the picture. \pre distance is the length of `local`
    [[nodiscard]] Answer locate(Vec3 local, double distance) const {
        if (!(distance > 0)) return Answer::Unsure;
        const double cosine = local.x / distance;
        if (cosine < least_ - kRounding) return has_all_ ? Answer::Outside : Answer::Unsure;
        if (cosine < least_ + kRounding) return Answer::Unsure;
        const double scale = stretchOf(cosine) / distance;
        const double u = -scale * local.y, v = -scale * local.z;
        const double inside =
            std::min(std::min(u - low_.x, high_.x - u), std::min(v - low_.y, high_.y - v));
        if (std::fabs(inside) <= margin_) return Answer::Unsure;
        return inside > 0 ? Answer::Inside : Answer::Outside;
    }

  private:
    static constexpr int kSteps = 256;
    static constexpr double kSafety = 8, kRounding = 1e-9;
    /// Beyond it neighbouring directions map to distant pixels.
    static constexpr Angle kLimit = Angle::radians(2.4);

    /// Returns the distance from the centre of the picture, in focal lengths, divided by the sine
    /// of the angle.
    static double stretchAt(const Camera& camera, double cosine) {
        const double sine = std::max(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 1e-5);
        const auto place = camera.project({cosine, -sine, 0});
        return place ? (place->column - camera.cx) / camera.fx / sine : 0;
    }
    [[nodiscard]] double stretchOf(double cosine) const {
        const double at = (cosine - least_) / step_;
        const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, kSteps - 1.0));
        return stretch_[i] + (at - static_cast<double>(i)) * (stretch_[i + 1] - stretch_[i]);
    }

    Vec2 low_, high_;       // the picture's bounds, in focal lengths from its centre
    bool has_all_ = false;  // the table spans the whole picture
    double least_ = 0, step_ = 0, margin_ = 0;
    std::array<double, kSteps + 1> stretch_{};
};

/// Returns the same as views[k].holds(), for views of one sensor that differ in heading.
class ViewTest {
  public:
    /// Stores the views. \pre at most kTogether
    explicit ViewTest(std::span<const FieldOfView> views) : views_(views) {
        const FieldOfView& first = views.front();
        is_pyramid_ = first.shape == FieldOfView::Shape::Pyramid;
        if (first.shape == FieldOfView::Shape::Picture && first.camera->lens != Lens::Pinhole)
            table_.emplace(*first.camera);
        if (!is_pyramid_) return;
        for (std::size_t k = 0; k < views.size(); ++k) {
            const Frame3& frame = views[k].frame;
            const Tangents& s = views[k].sides;
            setSide(0, k, 1, frame.left, s.left);
            setSide(1, k, -1, frame.left, s.right);
            setSide(2, k, 1, frame.up, s.up);
            setSide(3, k, -1, frame.up, s.down);
        }
    }

    [[nodiscard]] std::uint64_t holding(Point3 place) const {
        if (is_pyramid_) return pyramidsHolding(place);
        if (table_) return all([&](const FieldOfView& view) { return isInTable(view, place); });
        return all([&](const FieldOfView& view) { return view.holds(place); });
    }

  private:
    /// Outward normals of one side of each view.
    struct Normals {
        std::array<double, kTogether> x, y, z;
    };

    /// Sets a side of a view, by its axis and sign.
    void setSide(std::size_t side, std::size_t view, double sign, Vec3 axis, double tangent) {
        const Vec3& forward = views_[view].frame.forward;
        sides_[side].x[view] = sign * axis.x - tangent * forward.x;
        sides_[side].y[view] = sign * axis.y - tangent * forward.y;
        sides_[side].z[view] = sign * axis.z - tangent * forward.z;
    }
    template <typename Holds>
    [[nodiscard]] std::uint64_t all(Holds holds) const {
        std::uint64_t held = 0;
        for (std::size_t k = 0; k < views_.size(); ++k)
            if (holds(views_[k])) held |= std::uint64_t{1} << k;
        return held;
    }
    /// Decides nearly all points in a loop over all views that compilers vectorise.
    [[nodiscard]] std::uint64_t pyramidsHolding(Point3 place) const {
        constexpr double kEdge = 1e-9;  // exceeds the margin for rounding
        const Vec3 way = place - views_.front().frame.origin;
        const double edge = kEdge * (std::fabs(way.x) + std::fabs(way.y) + std::fabs(way.z));
        std::array<double, kTogether> beyond;
        const auto out = [&](const Normals& n, std::size_t k) {
            return n.x[k] * way.x + n.y[k] * way.y + n.z[k] * way.z;
        };
        for (std::size_t k = 0; k < views_.size(); ++k)
            beyond[k] = std::max(std::max(out(sides_[0], k), out(sides_[1], k)),
                                 std::max(out(sides_[2], k), out(sides_[3], k)));
        std::uint64_t held = 0;
        for (std::size_t k = 0; k < views_.size(); ++k) {
            if (beyond[k] > edge) continue;
            const FieldOfView& view = views_[k];
            const Vec3 local = view.frame.toLocal(place);
            if (beyond[k] >= -edge && !view.points(local)) continue;
            const double range = view.is_by_depth ? local.x : std::sqrt(dot(local, local));
            if (withinRange(range, view.max_range)) held |= std::uint64_t{1} << k;
        }
        return held;
    }
    [[nodiscard]] bool isInTable(const FieldOfView& view, Point3 place) const {
        const Vec3 local = view.frame.toLocal(place);
        const double distance = std::sqrt(dot(local, local));
        if (!withinRange(distance, view.max_range)) return false;
        const PictureTable::Answer answer = table_->locate(local, distance);
        if (answer == PictureTable::Answer::Unsure) return view.points(local);
        return answer == PictureTable::Answer::Inside;
    }

    std::span<const FieldOfView> views_;
    bool is_pyramid_ = false;
    std::array<Normals, 4> sides_;  // of pyramids
    std::optional<PictureTable> table_;
};

}  // namespace

CellWindow CellWindow::of(const Grid& grid, const CellSet& cells) {
    CellWindow window{grid.rows, 0, grid.columns, 0};
    cells.forEach([&](std::size_t cell) {
        const int row = static_cast<int>(cell) / grid.columns;
        const int column = static_cast<int>(cell) % grid.columns;
        window.first_row = std::min(window.first_row, row);
        window.end_row = std::max(window.end_row, row + 1);
        window.first_column = std::min(window.first_column, column);
        window.end_column = std::max(window.end_column, column + 1);
    });
    return window;
}

void cellsByView(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
                 double height, CellParts& parts, const CellWindow& window) {
    parts.runs.clear();
    parts.first.assign(1, 0);
    for (std::size_t begin = 0; begin < views.size(); begin += kTogether) {
        const auto some = views.subspan(begin, std::min(kTogether, views.size() - begin));
        const Point3 origin = some[0].frame.origin;
        const auto reach = Reach::of(origin, some[0].farthest(), height - origin.z);
        if (!reach) {
            parts.first.insert(parts.first.end(), some.size(), 0);
            continue;
        }
        const ViewTest test(some);
        const auto target_of = [&](Point2 center) {
            const Point3 place{center.x, center.y, height};
            return CellTarget{place, test.holding(place)};
        };
        addParts(grid, mesh, *reach, some.size(), target_of, parts, window);
    }
}

CellSet cellsOnPlane(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height) {
    CellParts parts;
    parts.first.assign(1, 0);
    if (const auto view = fieldOfView(sensor))
        cellsByView(grid, mesh, {&*view, 1}, height, parts);
    else if (sensor.as<Laser>().sweep == SweepAxis::None)
        addScan(grid, mesh, sensor, parts);
    else
        addSweep(grid, mesh, sensor, height, parts);
    return parts.size() == 0 ? CellSet(grid.size()) : cellsOf(parts, 0, grid.size());
}

}  // namespace ispace
