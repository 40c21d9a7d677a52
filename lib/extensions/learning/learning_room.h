// SPDX-License-Identifier: GPL-3.0-or-later
// A room that many worlds share: its walls for rays and circles, the cells of its floor that a
// robot can stand on, and goals with the ways to them. Immutable once built, and so thread-safe.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/random.h"
#include "extensions/learning/learning_task.h"
#include "geom/pose.h"
#include "scene/scene.h"
#include "sense/scan.h"
#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "sim/steering.h"
#include "trace/ray_world.h"

namespace ispace::learning {

/// Random numbers of an episode: SplitMix64, the same on every machine.
class EpisodeRandom {
  public:
    explicit EpisodeRandom(std::uint64_t seed = 0) : state_(seed) {}
    std::uint64_t bits() { return mixedBits(state_++); }
    /// In [0, 1).
    double unit() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
    double within(const TaskRange& range) {
        return range.isOne() ? range.low : range.low + unit() * (range.high - range.low);
    }
    /// A number below `count`. \pre count > 0
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>((static_cast<__uint128_t>(bits()) * count) >> 64U);
    }

  private:
    std::uint64_t state_;
};

/// A grid of square cells over the floor.
struct FloorCells {
    static constexpr double kSide = 0.2;  ///< metres

    Point2 low;
    int columns = 0, rows = 0;

    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] Point2 center(std::size_t cell) const {
        const auto wide = static_cast<std::size_t>(columns);
        const std::size_t column = cell % wide, row = cell / wide;
        return {low.x + kSide * (static_cast<double>(column) + 0.5),
                low.y + kSide * (static_cast<double>(row) + 0.5)};
    }
};

/// The ways to a point from the cells about it.
class PathsTo {
  public:
    /// Measures ways of at most `farthest` metres over the cells in `is_free`, to the centre of
    /// `cell`. O(cells within reach)
    PathsTo(const FloorCells& cells, std::span<const std::uint8_t> is_free, std::size_t cell,
            double farthest);

    /// Returns the metres from a point, by the best of the four cells around it; empty if none of
    /// them has a way.
    [[nodiscard]] std::optional<double> from(Point2 p) const;
    /// Returns the metres from the centre of a cell of the grid; empty without a way.
    [[nodiscard]] std::optional<double> fromCell(const FloorCells& cells, std::size_t cell) const;
    /// Calls visit(cell, metres) for the cells of the grid with a way.
    template <typename Visit>
    void forEachCell(const FloorCells& cells, Visit visit) const {
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column) {
                const std::uint16_t cost = costAt(column, row);
                if (cost == kNoPath) continue;
                visit(
                    static_cast<std::size_t>(row + row_) * static_cast<std::size_t>(cells.columns) +
                        static_cast<std::size_t>(column + column_),
                    cost * kMetres);
            }
    }

  private:
    static constexpr std::uint16_t kNoPath = 0xffff;
    static constexpr int kAlong = 12, kAcross = 17;  ///< costs of steps across a side and a corner
    static constexpr double kMetres = FloorCells::kSide / kAlong;

    [[nodiscard]] std::uint16_t costAt(int column, int row) const {
        return cost_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column)];
    }

    Point2 low_;
    int column_ = 0, row_ = 0, columns_ = 0, rows_ = 0;  // of the window in the grid
    std::vector<std::uint16_t> cost_;
};

/// A goal, and the cells from which a robot may be sent there.
struct RoomGoal {
    Point2 at;
    Angle heading;  ///< of a dock: towards its wall
    PathsTo ways;
    std::vector<std::uint32_t> starts;
};

/// Lines about each square metre of the floor, for the steering of people: shared vicinities that
/// are found once.
class SharedVicinities {
  public:
    SharedVicinities() = default;
    /// \param reach greatest distance that forEachWithin() is asked for
    SharedVicinities(const Obstacles& obstacles, const Box2& box, double reach);
    /// Returns the vicinity about p, which is not changed by queries up to the reach; null outside
    /// of the box.
    [[nodiscard]] Vicinity* at(Point2 p) const;

  private:
    static constexpr double kSide = 1;

    Point2 low_;
    int columns_ = 0, rows_ = 0;
    mutable std::vector<Vicinity> cells_;  // forEachWithin() changes none of them
};

/// Lower bounds of the distance to obstacles all over the floor, and their lines by cells.
class ClearanceField : public ObstacleIndex {
  public:
    ClearanceField() = default;
    ClearanceField(const Obstacles& obstacles, const Box2& box);
    [[nodiscard]] double least(Point2 p) const override;
    [[nodiscard]] Outlook look(const Segment2& way, double reach) const override;
    void findIn(const Box2& box, std::vector<Segment2>& lines) const override;
    [[nodiscard]] std::optional<Some> near(Point2 p) const override;
    [[nodiscard]] double most(Point2 p) const override;
    /// Returns a distance that no obstacle is nearer to p than, at most kNear: the distance to the
    /// nearest but for rounding; 0 outside of the box.
    [[nodiscard]] double clearanceAt(Point2 p) const;
    /// Returns true only if no obstacle comes nearer to the way than `reach`.
    [[nodiscard]] bool isClear(const Segment2& way, double reach) const;

  private:
    /// Square cells over the box.
    struct Cells {
        double side = 1;  // metres
        int columns = 0, rows = 0;

        Cells() = default;
        Cells(double cell_side, const Box2& box)
            : side(cell_side),
              columns(static_cast<int>(std::ceil(box.width() / side)) + 1),
              rows(static_cast<int>(std::ceil(box.depth() / side)) + 1) {}
        [[nodiscard]] std::size_t count() const {
            return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        }
    };
    template <typename Visit>
    void forEachCell(const Cells& cells, const Box2& box, Visit visit) const;
    void addLines(const Obstacles& obstacles, const Box2& box);
    void addNear(const std::vector<Segment2>& lines);

    /// Farther obstacles are taken to be so far away, metres.
    static constexpr double kFarthest = 3;
    static constexpr double kUnit = kFarthest / 255;  // of the stored distances
    static constexpr std::uint8_t kUnknown = 255;     // for those
    /// Cells of a tile along each side, which share a line of cache.
    static constexpr std::size_t kTile = 8;
    [[nodiscard]] std::size_t indexOf(std::size_t column, std::size_t row) const {
        return (row / kTile * tiles_ + column / kTile) * (kTile * kTile) + row % kTile * kTile +
               column % kTile;
    }
    /// Bounds of the distance to the nearest obstacle.
    struct Bounds {
        double least, most;
    };
    [[nodiscard]] Bounds boundsAt(Point2 p) const;

    Point2 low_;
    double side_ = 1, per_metre_ = 1;
    int columns_ = 0, rows_ = 0;
    std::size_t tiles_ = 1;            // in a row of them
    std::vector<std::uint8_t> least_;  // of the centres of cells, tile by tile, in kUnits
    Cells line_cells_, near_cells_;
    std::vector<std::uint32_t> first_;              // of each cell of lines, and the end
    std::vector<Segment2> lines_;                   // of all cells, one after another
    std::vector<Line> each_;                        // of these, once
    std::vector<std::uint32_t> near_first_, near_;  // likewise, of lines about a cell
};

/// A laser on a robot, and the slice that it sees.
struct RobotLaser {
    Sensor sensor;
    Pose3 mount;  ///< in the robot's frame
    double height = 0;
    const RayWorld* world = nullptr;
    std::unique_ptr<Beams> beams;  ///< of a moving sensor: any thread may turn them
    std::uint64_t hash = 0;        ///< of its id
};

class LearningRoom {
  public:
    /// Goals of a room alone, and the fewest of one among many.
    static constexpr std::size_t kGoals = 192, kFewGoals = 48;

    /// \param scene with robots, each with a level laser, and as many people as a world has at most
    /// \throws FormatError if a robot has no such laser, no two points of the floor suit the task,
    /// or the scene lacks its zone; as checkStart() if it has the starts
    LearningRoom(Scene scene, const LearningTask& task, std::size_t goals = kGoals);
    LearningRoom(const LearningRoom&) = delete;
    LearningRoom& operator=(const LearningRoom&) = delete;

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] std::size_t robots() const { return scene_.robots.size(); }
    [[nodiscard]] std::size_t people() const { return scene_.people.size(); }
    /// Returns robots, then people.
    [[nodiscard]] std::span<const Mover> movers() const { return movers_; }
    /// Returns the order in which moves of the first `count` movers are settled.
    [[nodiscard]] const std::vector<std::size_t>& order(std::size_t count) const {
        return orders_[count - robots()];
    }
    /// Returns the movers with the greatest speeds that an episode may give them.
    [[nodiscard]] std::span<const Mover> fastest() const { return fastest_; }
    [[nodiscard]] const Obstacles& obstaclesOf(std::size_t mover) const { return *stops_[mover]; }
    [[nodiscard]] const SharedVicinities& vicinitiesOfPerson(std::size_t person) const {
        return *vicinities_[person];
    }
    [[nodiscard]] const ClearanceField& clearanceOf(std::size_t mover) const {
        return *clearances_[mover];
    }
    [[nodiscard]] const FrictionMap& friction() const { return friction_; }
    [[nodiscard]] const RobotLaser& laser(std::size_t robot) const { return lasers_[robot]; }
    [[nodiscard]] std::size_t beams() const {
        return static_cast<std::size_t>(lasers_.front().sensor.as<Laser>().beams);
    }

    [[nodiscard]] const FloorCells& cells() const { return cells_; }
    [[nodiscard]] const std::vector<RoomGoal>& goals() const { return goals_; }
    /// Returns the cells of the largest connected floor that a robot can stand on, and those of
    /// them where a person can.
    [[nodiscard]] std::span<const std::uint32_t> robotCells() const { return robot_cells_; }
    [[nodiscard]] std::span<const std::uint32_t> personCells() const { return person_cells_; }
    /// Points of that floor, half a metre apart, that a patrol comes near.
    [[nodiscard]] std::span<const Point2> patrolPoints() const { return patrol_points_; }
    static constexpr double kPatrolSide = 0.5;
    /// Longest distance that a goal may have, metres.
    [[nodiscard]] double longest() const { return longest_; }
    /// The distances of goals: those of the task, or less if the room is too small for them.
    [[nodiscard]] const TaskRange& distances() const { return distances_; }

  private:
    void addLasers();
    void findFloor();
    void findGoals(const LearningTask& task, std::size_t count);
    [[nodiscard]] RoomGoal goalInZone(const LearningTask& task) const;
    [[nodiscard]] std::optional<Pose2> dockNear(std::size_t cell) const;

    Scene scene_;
    std::vector<Mover> movers_, fastest_;
    std::vector<std::vector<std::size_t>> orders_;  // by number of people
    ObstacleSets obstacles_;
    std::vector<const Obstacles*> stops_;  // by mover
    std::map<const Obstacles*, SharedVicinities> shared_;
    std::vector<const SharedVicinities*> vicinities_;  // by person
    std::map<const Obstacles*, ClearanceField> fields_;
    std::vector<const ClearanceField*> clearances_;  // by mover
    FrictionMap friction_;
    std::map<double, RayWorld> slices_;
    std::vector<RobotLaser> lasers_;
    FloorCells cells_;
    std::vector<std::uint8_t> free_;  // by cell: 1 if of robot_cells_
    std::vector<std::uint32_t> robot_cells_, person_cells_;
    std::vector<Point2> patrol_points_;
    std::vector<RoomGoal> goals_;
    TaskRange distances_;
    double longest_ = 0;
};

/// Returns the scene with the robots and people that its worlds have: those of the scene, robots of
/// the default kind with a laser of 181 beams if it has none, and as many people more as the task
/// asks for, wandering.
Scene learningScene(const Scene& scene, const LearningTask& task);

/// Returns another room by the rules of the task; the same for the same number.
/// \throws FormatError if none of many draws is a valid room
Scene furnitureVariant(const Scene& scene, const FurnitureRange& rules, std::uint64_t number);

}  // namespace ispace::learning
