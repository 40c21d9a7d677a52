// SPDX-License-Identifier: GPL-3.0-or-later
// Drives a Pioneer to a goal around obstacles: a global plan on the map of the room, the dynamic
// window approach for the next moment, and an extended Kalman filter that computes the robot's pose
// from its odometry and its sonars. It stops when its estimate is within 0.4 m of the goal.
//
//   cd share/scenes
//   envc ispace.env --slice 0.1 --resolution 0.02 -o map.yaml
//   simrun ispace.env ispace.3dm --clock step --listen 127.0.0.1:7001 --record run &
//   sleep 1
//   avoid map.yaml 0.5,2,-90 0.5,-2 -rrtp 7001 -o way.csv
//   kill $!; wait
//   simrun --replay run -o ways.svg
//
// Written for ARIA: on a real Pioneer, only the include path changes. With `--clock step` the world
// advances while the program sleeps, and each run is the same; with `--clock real` it takes its
// time. Exit status: 0 at the goal, 1 no map, way or robot, 2 usage, 3 not at the goal in time.
#include "Aria.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "avoid/dynamic_window.h"
#include "avoid/global_plan.h"
#include "avoid/grid_map.h"
#include "avoid/pose_filter.h"

namespace {

constexpr double kReached = 0.4;         // m from the goal
constexpr int kCycle = 100;              // ms
constexpr int kPatience = 120;           // s until it gives up
constexpr double kSonarFov = M_PI / 12;  // of a Pioneer's sonar

struct Task {
    std::string map, trajectory;
    avoid::Pose start = avoid::Pose::Zero();
    Eigen::Vector2d goal = Eigen::Vector2d::Zero();
    bool filter = true;
};

constexpr char kUsage[] =
    "usage: avoid MAP.yaml X,Y,HEADING X,Y [--odometry] [-o FILE] [-rrtp PORT] [-rh HOST]\n"
    "Drives from the first place to the second (m, degrees).\n"
    "  --odometry  trust the wheels alone\n"
    "  -o FILE     write where it believed to be, as CSV\n"
    "  -rrtp PORT, -rh HOST  where the robot is\n";

bool asksHelp(int argc, char** argv) {
    return std::any_of(argv, argv + argc, [](const char* word) {
        return std::strcmp(word, "--help") == 0 || std::strcmp(word, "-h") == 0;
    });
}

/// Parses numbers with commas between, and rejects other text.
bool readNumbers(const std::string& word, const std::vector<double*>& numbers) {
    const char* at = word.c_str();
    for (double* const number : numbers) {
        if (number != numbers.front() && *at++ != ',') return false;
        char* end = nullptr;
        *number = std::strtod(at, &end);
        if (end == at || !std::isfinite(*number)) return false;
        at = end;
    }
    return *at == '\0';
}

bool parse(ArArgumentParser& parser, Task& task) {
    task.filter = !parser.checkArgument("-odometry");
    if (const char* file = parser.checkParameterArgument("-o")) task.trajectory = file;
    const std::vector<std::string> words(parser.getArgv() + 1, parser.getArgv() + parser.getArgc());
    double heading = 0;
    if (words.size() != 3 || !readNumbers(words[1], {&task.start[0], &task.start[1], &heading}) ||
        !readNumbers(words[2], {&task.goal[0], &task.goal[1]}))
        return false;
    task.map = words[0];
    task.start[2] = ArMath::degToRad(heading);
    return true;
}

/// ARIA counts in mm and degrees.
avoid::Pose metres(const ArPose& pose) {
    return avoid::Pose(pose.getX() / 1000, pose.getY() / 1000, ArMath::degToRad(pose.getTh()));
}
ArPose millimetres(const avoid::Pose& pose) {
    return ArPose(1000 * pose.x(), 1000 * pose.y(), ArMath::radToDeg(pose.z()));
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// \return null for an empty path
File create(const std::string& path) {
    File file(path.empty() ? nullptr : std::fopen(path.c_str(), "w"), &std::fclose);
    if (!path.empty() && !file) throw std::runtime_error("cannot write " + path);
    return file;
}

/// Drives the robot to the goal by its map, odometry and sonars.
class Navigator {
  public:
    Navigator(ArRobot& robot, const avoid::GridMap& map, const Task& task, std::FILE* trajectory)
        : robot_(robot),
          task_(task),
          limits_(limitsOf(robot)),
          plan_(map, task.goal, limits_.radius),
          window_(map, plan_, limits_),
          filter_(map, task.start),
          odometry_(task.start),
          file_(trajectory) {
        if (file_)
            std::fprintf(file_, "t,odometry_x,odometry_y,odometry_heading_deg,x,y,heading_deg\n");
    }

    bool hasWay() const { return !plan_.way(task_.start.head<2>()).empty(); }
    double left() const { return (pose().head<2>() - task_.goal).norm(); }
    double driven() const { return driven_; }

    /// Reads the robot's measurements since the last cycle. The caller holds the robot's lock.
    void sense(double time) {
        const avoid::Pose odometry = metres(robot_.getPose());
        const avoid::Pose step = avoid::difference(odometry_, odometry);
        odometry_ = odometry;
        driven_ += step.head<2>().norm();
        filter_.predict(step);
        // All ranges in each cycle, be they new or not. Where sonars take turns, as on a real
        // Pioneer, an old range counts again and makes the filter surer than it may be.
        for (int i = 0; task_.filter && i < robot_.getNumSonar(); ++i) {
            const double range = robot_.getSonarRange(i) / 1000.0;
            if (range < kFarthest) filter_.correct(mountOf(i), range);
        }
        const avoid::Pose at = pose();
        if (file_)
            std::fprintf(file_, "%.3f,%.4f,%.4f,%.3f,%.4f,%.4f,%.3f\n", time, odometry.x(),
                         odometry.y(), ArMath::radToDeg(odometry.z()), at.x(), at.y(),
                         ArMath::radToDeg(at.z()));
    }

    /// Sets the speeds of the next cycle.
    void drive() {
        if (robot_.isLeftMotorStalled() || robot_.isRightMotorStalled()) backing_ = 10;
        if (backing_ > 0) {
            --backing_;
            robot_.setVel(-100);
            robot_.setRotVel(0);
            return;
        }
        avoid::Speeds now;
        now.ahead = robot_.getVel() / 1000;
        now.turn = ArMath::degToRad(robot_.getRotVel());
        const avoid::Speeds next = window_.choose(pose(), now, echoes());
        robot_.setVel(1000 * next.ahead);
        robot_.setRotVel(ArMath::radToDeg(next.turn));
    }

  private:
    static constexpr double kFarthest = 3.4;  // m
    static constexpr double kNear = 1;        // m

    static avoid::Limits limitsOf(const ArRobot& robot) {
        avoid::Limits limits;
        limits.radius = robot.getRobotRadius() / 1000;
        return limits;
    }

    avoid::Pose pose() const { return task_.filter ? filter_.pose() : odometry_; }

    avoid::SonarMount mountOf(int sonar) const {
        const ArSensorReading* const reading = robot_.getSonarReading(sonar);
        return {avoid::Pose(reading->getSensorX() / 1000, reading->getSensorY() / 1000,
                            ArMath::degToRad(reading->getSensorTh())),
                kSonarFov};
    }

    /// Near things, on the axes of the sonars that hear them.
    std::vector<Eigen::Vector2d> echoes() const {
        std::vector<Eigen::Vector2d> places;
        for (int i = 0; i < robot_.getNumSonar(); ++i) {
            const double range = robot_.getSonarRange(i) / 1000.0;
            if (range >= kNear) continue;
            const avoid::Pose from = avoid::compose(pose(), mountOf(i).place);
            places.push_back(avoid::compose(from, avoid::Pose(range, 0, 0)).head<2>());
        }
        return places;
    }

    ArRobot& robot_;
    const Task& task_;
    avoid::Limits limits_;
    avoid::GlobalPlan plan_;
    avoid::DynamicWindow window_;
    avoid::PoseFilter filter_;
    avoid::Pose odometry_;
    std::FILE* file_;  // may be null
    double driven_ = 0;
    int backing_ = 0;  // cycles
};

/// Brakes and waits until the robot stands.
void rest(ArRobot& robot) {
    for (bool moves = true; moves && robot.isConnected();) {
        robot.lock();
        robot.setVel(0);
        robot.setRotVel(0);
        robot.unlock();
        ArUtil::sleep(kCycle);
        robot.lock();
        moves = robot.getVel() != 0 || robot.getRotVel() != 0;
        robot.unlock();
    }
}

/// \return the exit status
int drive(ArRobot& robot, const avoid::GridMap& map, const Task& task, std::FILE* trajectory) {
    robot.lock();
    robot.moveTo(millimetres(task.start));
    Navigator navigator(robot, map, task, trajectory);
    robot.unlock();
    if (!navigator.hasWay()) {
        std::fprintf(stderr, "avoid: the map has no way there\n");
        return 1;
    }
    const ArTime begun;
    bool reached = false;
    while (!reached && begun.secSince() < kPatience && robot.isConnected()) {
        robot.lock();
        navigator.sense(static_cast<double>(begun.mSecSince()) / 1000);
        reached = navigator.left() < kReached;
        if (!reached) navigator.drive();
        robot.unlock();
        if (!reached) ArUtil::sleep(kCycle);
    }
    rest(robot);
    robot.lock();
    navigator.sense(static_cast<double>(begun.mSecSince()) / 1000);
    robot.unlock();
    std::printf("%s: %.2f m from the goal after %.1f s and %.2f m\n",
                reached ? "reached" : "gave up", navigator.left(),
                static_cast<double>(begun.mSecSince()) / 1000, navigator.driven());
    return reached ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) try {
    if (asksHelp(argc, argv)) {
        std::fputs(kUsage, stdout);
        return 0;
    }
    Aria::init();
    ArArgumentParser parser(&argc, argv);
    ArSimpleConnector connector(&parser);
    connector.parseArgs();
    Task task;
    if (!parse(parser, task)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const File trajectory = create(task.trajectory);
    const avoid::GridMap map = avoid::GridMap::read(task.map);

    ArRobot robot;
    ArSonarDevice sonar;
    if (!connector.connectRobot(&robot)) {
        std::fprintf(stderr, "avoid: no robot answers (is simrun running, -rrtp its port?)\n");
        return 1;
    }
    robot.addRangeDevice(&sonar);
    robot.comInt(ArCommands::ENABLE, 1);
    robot.comInt(ArCommands::SONAR, 1);
    robot.runAsync(true);
    ArUtil::sleep(2 * kCycle);  // until the first packet is there
    const int status = drive(robot, map, task, trajectory.get());
    robot.stopRunning();
    robot.disconnect();
    Aria::shutdown();
    return status;
} catch (const std::exception& error) {
    std::fprintf(stderr, "avoid: %s\n", error.what());
    return 1;
}
