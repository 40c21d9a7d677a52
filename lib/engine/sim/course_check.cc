// SPDX-License-Identifier: GPL-3.0-or-later
// Legs that are straight and free with 15 cm to spare need no walk: no mover steers nearer. Others
// are walked by a world with the one mover. The body that is named is the first on the line, found
// by bisection of the line.
#include "sim/course_check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/number.h"
#include "sim/collision.h"
#include "sim/mover.h"
#include "sim/world.h"

namespace ispace {

namespace {

/// Steps of all walks together, and the steps that preparing a walk takes for each element.
constexpr std::int64_t kMaxSteps = 4'000'000;
constexpr std::int64_t kStepsOfElement = 4;

class CourseCheck {
  public:
    explicit CourseCheck(const Scene& scene)
        : scene_(scene), context_(scene), movers_(moversOf(scene)), obstacles_(obstacleSets()) {}

    std::vector<Finding> run() {
        for (std::size_t record = 0; record < scene_.records.size(); ++record) {
            const PlacedRecord* const placed = context_.placed_of[record];
            const std::string& keyword = scene_.records[record].keyword();
            if (placed == nullptr || (keyword != "robot" && keyword != "human")) continue;
            const std::size_t mover =
                placed->index + (keyword == "human" ? scene_.robots.size() : 0);
            if (!movers_[mover].course.path.empty()) check(record, mover);
            if (isFull(findings_)) break;
        }
        if (steps_ > kMaxSteps)
            findings_.push_back({.message = "the room has too many paths to walk all of them",
                                 .hint = "check it in parts",
                                 .source = movers_.front().place});
        return std::move(findings_);
    }

  private:
    /// Obstacles of the movers with a path.
    [[nodiscard]] ObstacleSets obstacleSets() const {
        std::vector<Mover> going;
        std::copy_if(movers_.begin(), movers_.end(), std::back_inserter(going),
                     [](const Mover& mover) { return !mover.course.path.empty(); });
        return obstaclesOf(scene_.environment, going);
    }

    /// Checks each leg by itself, from rest: after a leg that fails it goes on from the goal, if
    /// the mover has room there, else from where it gave up. So one bad leg leads to one finding.
    void check(std::size_t record, std::size_t index) {
        const Mover& mover = movers_[index];
        const Obstacles& obstacles = obstacles_.at(mover.model.height);
        Pose2 at = mover.pose;
        const auto is_free = [&](Point2 p) {
            return !obstacles.overlap(p, mover.model.radius).has_value();
        };
        if (context_.isOut(at.position) || (!mover.is_person && !is_free(at.position))) return;
        std::vector<Point2> goals = mover.course.path;
        if (mover.course.loop) goals.push_back(goals.front());
        for (const Point2 goal : goals) {
            if (isFull(findings_) || steps_ > kMaxSteps) return;
            const Vec2 leg = goal - at.position;
            const Pose2 arrived{
                goal, length(leg) > 0 ? Angle::radians(std::atan2(leg.y, leg.x)) : at.heading};
            const auto given_up = isStraight(obstacles, {at.position, goal}, mover.model.radius)
                                      ? std::nullopt
                                      : walk(index, at, goal);
            if (given_up && !context_.isOut(goal)) report(record, mover, at.position, goal);
            at = given_up && (context_.isOut(goal) || !is_free(goal)) ? *given_up : arrived;
        }
    }

    /// Returns true if the circle can go straight, farther from all obstacles than any mover
    /// steers.
    static bool isStraight(const Obstacles& obstacles, const Segment2& leg, double radius) {
        constexpr double kSpare = 0.15;
        return !obstacles.near(leg, radius + kSpare) && !obstacles.overlap(leg.b, radius);
    }

    /// Walks from rest to a point. \returns the pose at which it is given up
    std::optional<Pose2> walk(std::size_t index, const Pose2& from, Point2 goal) {
        const Mover& mover = movers_[index];
        // It touches a body, where no run begins.
        if (!mover.is_person &&
            obstacles_.at(mover.model.height).overlap(from.position, mover.model.radius))
            return from;
        auto alone = std::make_shared<Scene>(Scene{{}, {}, scene_.environment, {}, {}, {}, {}, {}});
        MotionPlan plan;
        plan.path = {goal};
        if (mover.is_person) {
            alone->people = {scene_.people[index - scene_.robots.size()]};
            alone->people.front().pose = from;
            alone->people.front().course = {};
        } else {
            alone->robots = {scene_.robots[index]};
            alone->robots.front().pose = from;
            alone->robots.front().course = {};
        }
        steps_ += kStepsOfElement * static_cast<std::int64_t>(scene_.environment.elements().size());
        World world(alone, std::chrono::milliseconds(5));
        world.command(0, pathCommand(std::move(plan)));
        // It makes progress, if slowly.
        const double most = 120 + 10 * distance(from.position, goal) / mover.model.speed;
        while (seconds(world.time()) < most && steps_ <= kMaxSteps) {
            world.step();
            ++steps_;
            if (!world.unreached().empty()) return world.status(0).pose;
            if (!world.ends().empty()) return std::nullopt;
        }
        return std::nullopt;
    }

    /// Names the nearest cause: a body at the goal, else one across the line, else one that leaves
    /// less room than the mover needs.
    void report(std::size_t record, const Mover& mover, Point2 from, Point2 goal) {
        const Obstacles& obstacles = obstacles_.at(mover.model.height);
        const double radius = mover.model.radius;
        if (const auto body = obstacles.overlap(goal, radius)) {
            findings_.push_back(context_.finding(record, Severity::Warning, goal,
                                                 " has a path to " + placeText(goal) + ", where " +
                                                     context_.elementName(*body) +
                                                     " leaves it no room",
                                                 "move that point away"));
            return;
        }
        const std::string leg =
            " has a path whose leg from " + placeText(from) + " to " + placeText(goal);
        constexpr double kLine = 1e-3;
        if (const auto body = firstOn(obstacles, {from, goal}, kLine)) {
            const bool is_door = context_.element(*body).record.keyword() == "door";
            findings_.push_back(context_.finding(
                record, Severity::Warning, from,
                leg + " crosses " + context_.elementName(*body) + " and is given up there",
                is_door ? "open it, or lead the path round" : "lead the path round it"));
            return;
        }
        const auto body = firstOn(obstacles, {from, goal}, radius);
        findings_.push_back(context_.finding(
            record, Severity::Warning, from,
            leg + " is given up: its radius is " + formatFixed(radius, 2) + " m, and " +
                (body ? context_.elementName(*body) + " leaves less room"
                      : std::string("bodies on both sides leave hardly more room")),
            "widen the gap, or lead the path round"));
    }

    /// Returns the element that a circle meets first on a line.
    static std::optional<std::size_t> firstOn(const Obstacles& obstacles, const Segment2& line,
                                              double radius) {
        constexpr int kHalvings = 30;
        auto found = obstacles.stop(line, radius);
        double free = 0, met = 1;
        for (int i = 0; found && i < kHalvings; ++i) {
            const double middle = (free + met) / 2;
            const auto nearer =
                obstacles.stop({line.a, line.a + middle * (line.b - line.a)}, radius);
            (nearer ? met : free) = middle;
            if (nearer) found = nearer;
        }
        return found;
    }

    const Scene& scene_;
    CheckContext context_;
    std::vector<Mover> movers_;
    ObstacleSets obstacles_;  // by height
    std::vector<Finding> findings_;
    std::int64_t steps_ = 0;
};

}  // namespace

std::vector<Finding> checkCourses(const Scene& scene) {
    const auto has_path = [](const auto& mover) { return !mover.course.path.empty(); };
    if (std::none_of(scene.robots.begin(), scene.robots.end(), has_path) &&
        std::none_of(scene.people.begin(), scene.people.end(), has_path))
        return {};
    return CourseCheck(scene).run();
}

}  // namespace ispace
