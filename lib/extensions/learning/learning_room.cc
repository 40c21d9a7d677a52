// SPDX-License-Identifier: GPL-3.0-or-later
// Precomputes what thousands of worlds of one room ask all the time: free cells, goals with the
// ways to them, lines by cells, and lower bounds of clearances. Ways are shortest paths over 8
// neighbours with costs 12 and 17 (R. B. Dial, Algorithm 360: shortest-path forest with topological
// ordering, 1969): 17 / 12 is within 0.2 % of the square root of 2.
#include "extensions/learning/learning_room.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "env/body.h"
#include "env/point_location.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sense/selection.h"

namespace ispace::learning {

namespace {

/// Metres between a robot at its start or goal and the nearest body, and by which its position
/// deviates from the centre of a cell.
constexpr double kFloorMargin = 0.05;
/// Metres of way beyond the longest that leads to a goal: robots stray.
constexpr double kStray = 3;

FloorCells cellsOver(const Box2& box) {
    const auto count = [](double length) {
        return std::max(1, static_cast<int>(std::ceil(length / FloorCells::kSide)));
    };
    return {box.low, count(box.width()), count(box.depth())};
}

}  // namespace

PathsTo::PathsTo(const FloorCells& cells, std::span<const std::uint8_t> is_free, std::size_t cell,
                 double farthest) {
    const auto wide = static_cast<std::size_t>(cells.columns);
    const int column = static_cast<int>(cell % wide), row = static_cast<int>(cell / wide);
    const int reach = static_cast<int>(std::min(farthest / FloorCells::kSide + 1, 5000.0));
    column_ = std::max(0, column - reach);
    row_ = std::max(0, row - reach);
    columns_ = std::min(cells.columns - 1, column + reach) - column_ + 1;
    rows_ = std::min(cells.rows - 1, row + reach) - row_ + 1;
    low_ = {cells.low.x + FloorCells::kSide * column_, cells.low.y + FloorCells::kSide * row_};
    cost_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNoPath);
    const int most = static_cast<int>(std::min(farthest / kMetres, kNoPath - 1.0));
    const auto free_at = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return false;
        return is_free[static_cast<std::size_t>(y + row_) * wide +
                       static_cast<std::size_t>(x + column_)] != 0;
    };
    // Dial's algorithm, as PathFinder has it, on cells twice as wide.
    struct Entry {
        int column, row, cost;
    };
    std::array<std::vector<Entry>, kAcross + 1> buckets;
    const auto add = [&](int x, int y, int cost) {
        if (cost > most || !free_at(x, y)) return false;
        std::uint16_t& known =
            cost_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(x)];
        if (known <= cost) return false;
        known = static_cast<std::uint16_t>(cost);
        buckets[static_cast<std::size_t>(cost) % buckets.size()].push_back({x, y, cost});
        return true;
    };
    std::size_t waiting = add(column - column_, row - row_, 0) ? 1 : 0;
    for (int sum = 0; waiting > 0; ++sum) {
        std::vector<Entry>& entries = buckets[static_cast<std::size_t>(sum) % buckets.size()];
        const std::vector<Entry> now = std::exchange(entries, {});
        waiting -= now.size();
        for (const Entry& entry : now) {
            const int x = entry.column, y = entry.row, cost = entry.cost;
            if (costAt(x, y) != cost) continue;
            const bool east = free_at(x + 1, y), west = free_at(x - 1, y);
            const bool north = free_at(x, y + 1), south = free_at(x, y - 1);
            const auto go = [&](bool may, int to_x, int to_y, int step) {
                if (may && add(x + to_x, y + to_y, cost + step)) ++waiting;
            };
            go(east, 1, 0, kAlong);
            go(west, -1, 0, kAlong);
            go(north, 0, 1, kAlong);
            go(south, 0, -1, kAlong);
            go(north && east, 1, 1, kAcross);
            go(north && west, -1, 1, kAcross);
            go(south && east, 1, -1, kAcross);
            go(south && west, -1, -1, kAcross);
        }
    }
}

std::optional<double> PathsTo::from(Point2 p) const {
    const double x = (p.x - low_.x) / FloorCells::kSide - 0.5;
    const double y = (p.y - low_.y) / FloorCells::kSide - 0.5;
    if (!(x > -1 && y > -1 && x < columns_ && y < rows_)) return std::nullopt;
    const int left = static_cast<int>(std::floor(x)), bottom = static_cast<int>(std::floor(y));
    std::optional<double> best;
    for (int row = std::max(0, bottom); row <= std::min(rows_ - 1, bottom + 1); ++row)
        for (int column = std::max(0, left); column <= std::min(columns_ - 1, left + 1); ++column) {
            const std::uint16_t cost = costAt(column, row);
            if (cost == kNoPath || (best && cost * kMetres >= *best)) continue;
            const double way = cost * kMetres + FloorCells::kSide * std::hypot(x - column, y - row);
            if (!best || way < *best) best = way;
        }
    return best;
}

std::optional<double> PathsTo::fromCell(const FloorCells& cells, std::size_t cell) const {
    const auto wide = static_cast<std::size_t>(cells.columns);
    const int column = static_cast<int>(cell % wide) - column_;
    const int row = static_cast<int>(cell / wide) - row_;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return std::nullopt;
    const std::uint16_t cost = costAt(column, row);
    return cost == kNoPath ? std::nullopt : std::optional(cost * kMetres);
}

SharedVicinities::SharedVicinities(const Obstacles& obstacles, const Box2& box, double reach)
    : low_(box.low),
      columns_(static_cast<int>(std::ceil(std::max(kSide, box.width()) / kSide))),
      rows_(static_cast<int>(std::ceil(std::max(kSide, box.depth()) / kSide))),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    constexpr double kHalfDiagonal = 0.71 * kSide;
    tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
        const std::size_t row = i / static_cast<std::size_t>(columns_);
        const std::size_t column = i % static_cast<std::size_t>(columns_);
        const Point2 middle{low_.x + kSide * (static_cast<double>(column) + 0.5),
                            low_.y + kSide * (static_cast<double>(row) + 0.5)};
        cells_[i].forEachWithin(obstacles, middle, reach + kHalfDiagonal,
                                [](const Segment2&, double) {});
    });
}

Vicinity* SharedVicinities::at(Point2 p) const {
    const double x = (p.x - low_.x) / kSide, y = (p.y - low_.y) / kSide;
    if (!(x >= 0 && y >= 0 && x < columns_ && y < rows_)) return nullptr;
    return &cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(x)];
}

ClearanceField::ClearanceField(const Obstacles& obstacles, const Box2& box) : low_(box.low) {
    constexpr double kLeastSide = 0.1, kMostCells = 4e5;
    side_ = std::max(kLeastSide, std::sqrt(box.width() * box.depth() / kMostCells));
    per_metre_ = 1 / side_;
    columns_ = static_cast<int>(std::ceil(box.width() / side_)) + 1;
    rows_ = static_cast<int>(std::ceil(box.depth() / side_)) + 1;
    const auto tiles_of = [](int cells) { return static_cast<std::size_t>(cells) / kTile + 1; };
    tiles_ = tiles_of(columns_);
    least_.resize(tiles_ * tiles_of(rows_) * kTile * kTile);
    // From the centre of a cell, rounded down.
    tbb::parallel_for(0, rows_, [&](int row) {
        for (int column = 0; column < columns_; ++column) {
            const Point2 center{low_.x + side_ * (column + 0.5), low_.y + side_ * (row + 0.5)};
            const double least = obstacles.nearest(center, kFarthest);
            least_[indexOf(static_cast<std::size_t>(column), static_cast<std::size_t>(row))] =
                least < kFarthest ? static_cast<std::uint8_t>(least / kUnit) : kUnknown;
        }
    });
    addLines(obstacles, box);
}

/// Calls visit(cell) for the cells that a box meets.
template <typename Visit>
void ClearanceField::forEachCell(const Cells& cells, const Box2& box, Visit visit) const {
    const auto within = [&](double at, int count) {
        return static_cast<int>(std::clamp(std::floor(at / cells.side), 0.0, count - 1.0));
    };
    const int left = within(box.low.x - low_.x, cells.columns);
    const int right = within(box.high.x - low_.x, cells.columns);
    const int bottom = within(box.low.y - low_.y, cells.rows);
    const int top = within(box.high.y - low_.y, cells.rows);
    for (int row = bottom; row <= top; ++row)
        for (int column = left; column <= right; ++column)
            visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(cells.columns) +
                  static_cast<std::size_t>(column));
}

/// Stores each line in all cells that its bounds meet.
void ClearanceField::addLines(const Obstacles& obstacles, const Box2& box) {
    constexpr double kLineSide = 0.5, kNearSide = 0.25;  // metres
    line_cells_ = Cells(kLineSide, box);
    near_cells_ = Cells(kNearSide, box);
    std::vector<Segment2> lines;
    const Point2 middle{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
    obstacles.findAbout(middle, std::hypot(box.width(), box.depth()), lines);
    first_.assign(line_cells_.count() + 1, 0);
    for (const Segment2& line : lines)
        forEachCell(line_cells_, bounds(line), [this](std::size_t cell) { ++first_[cell]; });
    std::uint32_t end = 0;
    for (std::uint32_t& entry : first_) entry = end += entry;
    lines_.resize(end);
    for (const Segment2& line : lines)
        forEachCell(line_cells_, bounds(line),
                    [&](std::size_t cell) { lines_[--first_[cell]] = line; });
    addNear(lines);
}

/// Stores in each cell the lines nearer than kNear to a point of it.
void ClearanceField::addNear(const std::vector<Segment2>& lines) {
    each_.reserve(lines.size());
    for (const Segment2& line : lines) {
        const Vec2 along = line.b - line.a;
        const double square = dot(along, along);
        each_.push_back({line.a, along, square > 0 ? 1 / square : 0});
    }
    const double side = near_cells_.side, reach = kNear + side * 0.7072;
    const auto for_each_entry = [&](auto visit) {
        for (std::size_t i = 0; i < lines.size(); ++i)
            forEachCell(near_cells_, bounds(lines[i]).expanded(kNear), [&](std::size_t cell) {
                const auto wide = static_cast<std::size_t>(near_cells_.columns);
                const std::size_t row = cell / wide, column = cell % wide;
                const Point2 center{low_.x + side * (static_cast<double>(column) + 0.5),
                                    low_.y + side * (static_cast<double>(row) + 0.5)};
                if (squaredDistance(center, lines[i]) < reach * reach)
                    visit(cell, static_cast<std::uint32_t>(i));
            });
    };
    near_first_.assign(near_cells_.count() + 1, 0);
    for_each_entry([this](std::size_t cell, std::uint32_t) { ++near_first_[cell]; });
    std::uint32_t end = 0;
    for (std::uint32_t& entry : near_first_) entry = end += entry;
    near_.resize(end);
    for_each_entry(
        [this](std::size_t cell, std::uint32_t line) { near_[--near_first_[cell]] = line; });
}

std::optional<ObstacleIndex::Some> ClearanceField::near(Point2 p) const {
    const double x = (p.x - low_.x) / near_cells_.side, y = (p.y - low_.y) / near_cells_.side;
    if (!(x >= 0 && y >= 0 && x < near_cells_.columns && y < near_cells_.rows)) return std::nullopt;
    const std::size_t cell =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(near_cells_.columns) +
        static_cast<std::size_t>(x);
    return Some{each_, std::span(near_).subspan(near_first_[cell],
                                                near_first_[cell + 1] - near_first_[cell])};
}

void ClearanceField::findIn(const Box2& box, std::vector<Segment2>& lines) const {
    lines.clear();
    const auto apart = [](double a, double b, double low, double high) {
        return std::max(a, b) < low || std::min(a, b) > high;
    };
    forEachCell(line_cells_, box, [&](std::size_t cell) {
        for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i)
            if (const Segment2& line = lines_[i];
                !apart(line.a.x, line.b.x, box.low.x, box.high.x) &&
                !apart(line.a.y, line.b.y, box.low.y, box.high.y))
                lines.push_back(line);
    });
}

inline ClearanceField::Bounds ClearanceField::boundsAt(Point2 p) const {
    const double x = (p.x - low_.x) * per_metre_, y = (p.y - low_.y) * per_metre_;
    if (!(x >= 0 && y >= 0 && x < columns_ && y < rows_))
        return {0, std::numeric_limits<double>::infinity()};
    const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
    const double across = std::abs(x - (static_cast<double>(column) + 0.5));
    const double along = std::abs(y - (static_cast<double>(row) + 0.5));
    // At least the distance to the centre.
    constexpr double kRoot = 0.4143, kRounding = 1e-6;
    const double off =
        side_ * (std::max(across, along) + kRoot * std::min(across, along)) + kRounding;
    const std::uint8_t stored = least_[indexOf(column, row)];
    const double distance = stored * kUnit;
    return {distance - off,
            stored == kUnknown ? std::numeric_limits<double>::infinity() : distance + kUnit + off};
}

double ClearanceField::least(Point2 p) const { return boundsAt(p).least; }

double ClearanceField::most(Point2 p) const { return boundsAt(p).most; }

double ClearanceField::clearanceAt(Point2 p) const {
    constexpr double kRounding = 1e-9;
    const auto some = near(p);
    if (!some) return 0;
    double least = kNear * kNear;
    for (const std::uint32_t i : some->which) {
        const Line& line = some->all[i];
        const Vec2 begin = line.begin - p;
        const double share = std::clamp(-dot(begin, line.along) * line.per_square, 0.0, 1.0);
        const Vec2 foot = begin + share * line.along;
        least = std::min(least, dot(foot, foot));
    }
    return std::max(0.0, std::sqrt(least) - kRounding);
}

bool ClearanceField::isClear(const Segment2& way, double reach) const {
    constexpr double kRounding = 1e-9;
    const double end = distance(way.a, way.b), allowed = reach + kRounding;
    // A shorter way crosses no line whose ends, and the way's, are apart.
    if (!(end < reach && allowed + end < kNear)) return false;
    const auto some = near(way.a);
    return some && std::none_of(some->which.begin(), some->which.end(), [&](std::uint32_t i) {
               const Line& line = some->all[i];
               const Segment2 wall{line.begin, line.begin + line.along};
               const double start = squaredDistance(way.a, wall);
               if (start > (allowed + end) * (allowed + end)) return false;
               return std::min({start, squaredDistance(way.b, wall), squaredDistance(wall.a, way),
                                squaredDistance(wall.b, way)}) <= allowed * allowed;
           });
}

ObstacleIndex::Outlook ClearanceField::look(const Segment2& way, double reach) const {
    // From circle to circle in which all is clear; where they are narrow, in short steps that only
    // look for an obstacle. The margin exceeds those that steering leaves for rounding.
    constexpr double kLeastStep = 0.05, kShortStep = 0.1, kMargin = 3e-6;
    const Vec2 along = way.b - way.a;
    const double end = std::sqrt(dot(along, along));
    const auto is_inside = [this](Point2 p) {
        const double x = (p.x - low_.x) * per_metre_, y = (p.y - low_.y) * per_metre_;
        return x >= 0 && y >= 0 && x < columns_ && y < rows_;
    };
    const double start_room = boundsAt(way.a).least - reach - kMargin;
    if (!(start_room >= 0) || !is_inside(way.b)) return Outlook::Unknown;
    if (start_room >= end) return Outlook::Clear;
    const auto is_blocked = [&](const Bounds& of) { return of.most < reach - kMargin; };
    if (is_blocked(boundsAt(way.b))) return Outlook::Blocked;
    const Vec2 unit = 1 / end * along;
    bool is_clear = start_room >= kLeastStep;
    for (double gone = is_clear ? start_room : kShortStep; gone < end;) {
        const Bounds here = boundsAt(way.a + gone * unit);
        if (is_blocked(here)) return Outlook::Blocked;
        const double room = here.least - reach - kMargin;
        is_clear = is_clear && room >= kLeastStep;
        if (is_clear && room >= end - gone) return Outlook::Clear;
        gone += is_clear ? room : std::max(room, kShortStep);
    }
    return is_clear ? Outlook::Clear : Outlook::Unknown;
}

LearningRoom::LearningRoom(Scene scene, const LearningTask& task, std::size_t goals)
    : scene_(std::move(scene)),
      movers_(moversOf(scene_)),
      fastest_(movers_),
      obstacles_(ispace::obstaclesOf(scene_.environment, movers_)),
      friction_(scene_.environment),
      cells_(cellsOver(scene_.environment.limits())),
      distances_(task.distance) {
    for (std::size_t i = 0; i < robots(); ++i) {
        fastest_[i].model.max_speed *= task.speed.high;
        fastest_[i].model.max_sidespeed *= task.speed.high;
    }
    for (std::size_t people = 0; people <= this->people(); ++people)
        orders_.push_back(settlingOrder(movers().first(robots() + people)));
    for (const Mover& mover : movers_) stops_.push_back(&obstacles_.at(mover.model.height));
    // Of a navigator: its circle, a gap, and its way in the time that must be free.
    constexpr double kMostTime = 2, kSlack = 0.5, kGap = 0.05;
    std::map<const Obstacles*, double> reaches;
    for (std::size_t i = robots(); i < movers_.size(); ++i) {
        const RobotModel& model = movers_[i].model;
        const double time = std::max(kMostTime, model.speed / model.accel + kSlack);
        double& reach = reaches[stops_[i]];
        reach = std::max(reach, model.radius + kGap + model.speed * time);
    }
    for (const auto& [obstacles, reach] : reaches)
        shared_.emplace(obstacles,
                        SharedVicinities(*obstacles, scene_.environment.limits(), reach));
    for (const Obstacles* const obstacles : stops_) {
        auto field = fields_.find(obstacles);
        if (field == fields_.end())
            field =
                fields_.emplace(obstacles, ClearanceField(*obstacles, scene_.environment.limits()))
                    .first;
        clearances_.push_back(&field->second);
    }
    for (std::size_t i = robots(); i < movers_.size(); ++i)
        vicinities_.push_back(&shared_.at(stops_[i]));
    if (task.starts_in_scene) checkStart(scene_, movers_, obstacles_);
    addLasers();
    findFloor();
    findGoals(task, goals);
}

void LearningRoom::addLasers() {
    LocalBeams local;
    for (std::size_t i = 0; i < robots(); ++i) {
        const auto carried =
            std::find_if(scene_.sensors.begin(), scene_.sensors.end(), [i](const Sensor& sensor) {
                return sensor.is<Laser>() && sensor.isOn(i) && scansSlice(sensor) &&
                       sensor.as<Laser>().sweep == SweepAxis::None;
            });
        if (carried == scene_.sensors.end())
            throw FormatError(scene_.robots[i].place.finding(
                "robot " + scene_.robots[i].id +
                " has no level laser to learn with; add one: laser on=" + scene_.robots[i].id));
        RobotLaser laser;
        laser.sensor = *carried;
        laser.mount = carried->mount->robot_from_sensor;
        laser.height = carried->pose.position.z;
        const Laser& model = carried->as<Laser>();
        laser.beams = std::make_unique<Beams>(model, true, local.of(model));
        laser.hash = hashOf(carried->id);
        auto slice = slices_.find(laser.height);
        if (slice == slices_.end())
            slice = slices_
                        .emplace(laser.height,
                                 RayWorld::ofLevel(scene_.environment, laser.height, nullptr))
                        .first;
        laser.world = &slice->second;
        lasers_.push_back(std::move(laser));
        if (model.beams != lasers_.front().sensor.as<Laser>().beams)
            throw FormatError(scene_.robots[i].place.finding(
                "the lasers of " + scene_.robots.front().id + " and " + scene_.robots[i].id +
                " differ in their number of beams"));
    }
}

/// Finds the largest connected floor for the widest robot.
void LearningRoom::findFloor() {
    double robot = 0, person = 0;
    std::size_t widest = 0;
    for (std::size_t i = 0; i < movers_.size(); ++i) {
        const double radius = movers_[i].model.radius;
        if (i < robots() && radius > robot) widest = i;
        (i < robots() ? robot : person) = std::max(i < robots() ? robot : person, radius);
    }
    const RegionIndex& indoor = scene_.environment.indoorIndex();
    free_.assign(cells_.count(), 0);
    std::vector<std::uint8_t> for_people(people() > 0 ? cells_.count() : 0, 0);
    tbb::parallel_for(0, cells_.rows, [&](int row) {
        for (int column = 0; column < cells_.columns; ++column) {
            const std::size_t cell =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_.columns) +
                static_cast<std::size_t>(column);
            const Point2 center = cells_.center(cell);
            if (indoor.locate(center) != Side::Inside) continue;
            free_[cell] = stops_[widest]->overlap(center, robot + kFloorMargin) ? 0 : 1;
            if (!for_people.empty())
                for_people[cell] = stops_[robots()]->overlap(center, person + kFloorMargin) ? 0 : 1;
        }
    });
    // Connected across sides: the ways go no farther.
    const auto wide = static_cast<std::size_t>(cells_.columns);
    std::vector<std::uint8_t> left = free_;
    for (std::size_t first = 0; first < left.size(); ++first) {
        if (left[first] == 0) continue;
        std::vector<std::uint32_t> part{static_cast<std::uint32_t>(first)};
        left[first] = 0;
        for (std::size_t k = 0; k < part.size(); ++k) {
            const std::size_t cell = part[k];
            const auto reach = [&](bool is_inside, std::size_t to) {
                if (!is_inside || left[to] == 0) return;
                left[to] = 0;
                part.push_back(static_cast<std::uint32_t>(to));
            };
            reach(cell % wide + 1 < wide, cell + 1);
            reach(cell % wide > 0, cell - 1);
            reach(cell + wide < left.size(), cell + wide);
            reach(cell >= wide, cell - wide);
        }
        if (part.size() > robot_cells_.size()) robot_cells_ = std::move(part);
    }
    std::sort(robot_cells_.begin(), robot_cells_.end());
    std::fill(free_.begin(), free_.end(), 0);
    std::unordered_set<std::uint64_t> patrolled;
    for (const std::uint32_t cell : robot_cells_) {
        free_[cell] = 1;
        if (!for_people.empty() && for_people[cell] != 0) person_cells_.push_back(cell);
        const Point2 center = cells_.center(cell);
        const auto part = [](double along) {
            return static_cast<std::uint64_t>(std::floor(along / kPatrolSide));
        };
        const std::uint64_t patch =
            (part(center.x - cells_.low.x) << 32U) | part(center.y - cells_.low.y);
        if (patrolled.insert(patch).second) patrol_points_.push_back(center);
    }
    const Box2& limits = scene_.environment.limits();
    longest_ = std::hypot(limits.width(), limits.depth()) + 1;
}

/// Returns a pose at a wall near a cell: its robot faces the wall, a margin away from it.
std::optional<Pose2> LearningRoom::dockNear(std::size_t cell) const {
    const double radius = movers_.front().model.radius, stand = radius + kFloorMargin + 0.01;
    const Point2 center = cells_.center(cell);
    std::vector<Segment2> lines;
    stops_.front()->findAbout(center, stand + FloorCells::kSide, lines);
    std::optional<Point2> foot;
    for (const Segment2& line : lines) {
        const Vec2 along = line.b - line.a;
        const double square = dot(along, along);
        if (!(square > 4 * radius * radius)) continue;  // narrower than the robot
        const double share = dot(center - line.a, along) / square;
        // The whole robot stands before the wall.
        const double margin = radius / std::sqrt(square);
        if (share < margin || share > 1 - margin) continue;
        const Point2 at = line.a + share * along;
        if (!foot || distance(at, center) < distance(*foot, center)) foot = at;
    }
    if (!foot || !(distance(*foot, center) > 0)) return std::nullopt;
    const Vec2 way = *foot - center;
    const Vec2 unit = 1 / length(way) * way;
    const Point2 at = *foot + -stand * unit;
    if (stops_.front()->overlap(at, radius + kFloorMargin)) return std::nullopt;
    return Pose2{at, directionOf(unit.x, unit.y)};
}

/// Returns the middle of the task's zone as a goal, with the ways from the whole floor.
RoomGoal LearningRoom::goalInZone(const LearningTask& task) const {
    const auto& elements = scene_.environment.elements();
    const auto zone = std::find_if(elements.begin(), elements.end(), [&](const Element& one) {
        return one.record.keyword() == "zone" && one.id == task.zone;
    });
    if (zone == elements.end())
        throw FormatError(
            Diagnostic{"", 0, 0, "the room has no zone " + task.zone + ", the goal of the task"});
    const Point2 at = bounds(zoneOutline(zone->record)).center();
    const auto nearer = [&](std::uint32_t a, std::uint32_t b) {
        return distance(cells_.center(a), at) < distance(cells_.center(b), at);
    };
    const std::uint32_t cell = *std::min_element(robot_cells_.begin(), robot_cells_.end(), nearer);
    if (distance(cells_.center(cell), at) > FloorCells::kSide)
        throw FormatError(
            Diagnostic{"", 0, 0, "the robots have no room in the middle of the zone " + task.zone});
    constexpr double kDetours = 4;
    RoomGoal goal{at, {}, PathsTo(cells_, free_, cell, kDetours * longest_), {}};
    goal.ways.forEachCell(cells_, [&](std::size_t start, double) {
        if (distance(cells_.center(start), at) > task.reach + FloorCells::kSide)
            goal.starts.push_back(static_cast<std::uint32_t>(start));
    });
    if (goal.starts.empty())
        throw FormatError(Diagnostic{"", 0, 0, "no way leads to the zone " + task.zone});
    return goal;
}

/// Draws cells without repetition and keeps those with a start in the task's range of distances;
/// if none has, the least distance is halved, six attempts in all.
void LearningRoom::findGoals(const LearningTask& task, std::size_t count) {
    if (robot_cells_.empty())
        throw FormatError(Diagnostic{"", 0, 0, "no floor of the room is free for the robots"});
    if (!task.zone.empty()) {
        if (task.kind != LearningTask::Kind::Goal)
            throw FormatError(
                Diagnostic{"", 0, 0, "goal: zone is for the task goal, not for other kinds"});
        goals_.push_back(goalInZone(task));
        return;
    }
    if (task.kind == LearningTask::Kind::Patrol || task.kind == LearningTask::Kind::Follow) return;
    // A fixed seed: a room has the same goals in each batch.
    EpisodeRandom random(1);
    std::vector<std::uint32_t> drawn = robot_cells_;
    for (std::size_t i = 0; i + 1 < drawn.size(); ++i)
        std::swap(drawn[i], drawn[i + random.below(drawn.size() - i)]);
    if (task.kind == LearningTask::Kind::Dock)
        std::erase_if(drawn, [this](std::uint32_t cell) { return !dockNear(cell); });
    if (drawn.size() > count) drawn.resize(count);
    for (int attempt = 0; attempt < 6 && goals_.empty(); ++attempt) {
        const double most = distances_.high * task.detour;
        std::vector<std::optional<RoomGoal>> found(drawn.size());
        tbb::parallel_for(std::size_t{0}, drawn.size(), [&](std::size_t i) {
            const std::uint32_t cell = drawn[i];
            RoomGoal goal{cells_.center(cell), {}, PathsTo(cells_, free_, cell, most + kStray), {}};
            if (task.kind == LearningTask::Kind::Dock) {
                const std::optional<Pose2> dock = dockNear(cell);
                goal.at = dock->position;
                goal.heading = dock->heading;
            }
            goal.ways.forEachCell(cells_, [&](std::size_t start, double way) {
                const double straight = distance(cells_.center(start), goal.at);
                if (straight >= distances_.low && straight <= distances_.high &&
                    way <= task.detour * straight)
                    goal.starts.push_back(static_cast<std::uint32_t>(start));
            });
            if (!goal.starts.empty()) found[i] = std::move(goal);
        });
        for (std::optional<RoomGoal>& goal : found)
            if (goal) goals_.push_back(std::move(*goal));
        if (goals_.empty()) distances_.low /= 2;
    }
    if (goals_.empty())
        throw FormatError(Diagnostic{
            "", 0, 0,
            "no two points of the floor are " + formatDouble(task.distance.low) + " to " +
                formatDouble(task.distance.high) + " m apart with a way of at most " +
                formatDouble(task.detour) + " times that: set goal in the task"});
}

namespace {

/// Returns ids such as r1, r2 that the scene does not use.
class FreshIds {
  public:
    explicit FreshIds(const Scene& scene) : used_(scene.ids.begin(), scene.ids.end()) {}
    std::string next(const std::string& letter) {
        for (int number = 1;; ++number)
            if (std::string id = letter + std::to_string(number); used_.insert(id).second)
                return id;
    }

  private:
    std::unordered_set<std::string> used_;
};

}  // namespace

Scene learningScene(const Scene& scene, const LearningTask& task) {
    FreshIds ids(scene);
    const Point2 inside = scene.environment.inside();
    const std::string at = formatDouble(inside.x) + ',' + formatDouble(inside.y);
    std::string lines = "#3dm 1\n";
    if (scene.robots.empty())
        for (int i = 0; i < task.robots; ++i) {
            const std::string robot = ids.next("r");
            // The robot of Gazebo's and JaxNav's examples: a metre a second, half a turn in 1.5 s.
            for (const std::string& part :
                 {std::string("robot id="), robot, " at=" + at,
                  std::string(" radius=0.2 height=0.4 speed=1 max_speed=1 accel=2 rotspeed=120"
                              " max_rotspeed=120 rotaccel=720\nlaser id="),
                  ids.next("l"), " on=" + robot,
                  std::string(" at=0,0,0.2 range=6 fov=180 step=1 rate="),
                  formatDouble(1 / seconds(task.step)), std::string("\n")})
                lines += part;
        }
    const auto people = static_cast<std::size_t>(std::lround(task.people.high));
    for (std::size_t i = scene.people.size(); i < people; ++i)
        lines += "human id=" + ids.next("p") + " at=" + at + " walk=wander\n";
    std::vector<Record> records = scene.records;
    const Document added = readRecordText(lines, "learner", sceneSchemas());
    records.insert(records.end(), added.records.begin(), added.records.end());
    return makeScene(std::move(records), scene, shippedDevices());
}

Scene furnitureVariant(const Scene& scene, const FurnitureRange& rules, std::uint64_t number) {
    constexpr int kDraws = 50;
    std::optional<FormatError> reason;
    for (int draw = 0; draw < kDraws; ++draw) {
        EpisodeRandom random(mixedBits(number) + static_cast<std::uint64_t>(draw));
        std::vector<Record> records;
        for (const Record& old : scene.records) {
            Record record = old;
            const Schema& schema = record.schema();
            if (schema.keyword == "door" && record.flag("open") && random.unit() < rules.close_door)
                record.set("open", Value(false));
            const bool is_piece = schema.type == RecordType::Other && record.has("at");
            if (is_piece) {
                if (random.unit() < rules.remove) continue;
                Tuple place = record.tuple("at");
                for (std::size_t k = 0; k < 2; ++k)
                    place[k] += std::round((2 * random.unit() - 1) * rules.shift * 1000) / 1000;
                record.set("at", Value(place));
                const double turn = std::round((2 * random.unit() - 1) * rules.turn);
                if (turn != 0 && record.find("heading") != nullptr)
                    record.set(
                        "heading",
                        Value(wrapped(record.angle("heading") + Angle::degrees(turn)).degrees()));
            }
            records.push_back(std::move(record));
        }
        try {
            return makeScene(std::move(records), scene, shippedDevices());
        } catch (const FormatError& error) {
            reason = error;
        }
    }
    throw *reason;
}

}  // namespace ispace::learning
