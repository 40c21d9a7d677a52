// SPDX-License-Identifier: GPL-3.0-or-later
// CARMEN's logs (carmen.sourceforge.net, "Log file format": FLASER, ROBOTLASER, ODOM). The format
// does not say which of two poses is corrected, nor the bearings of FLASER: both are decided by the
// whole log.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/number.h"
#include "extensions/reality/log_parts.h"

namespace ispace::reality {

namespace {

constexpr double kFarthestPlace = 1e6;  // metres
constexpr double kCarmenNoReturn = 80;  // of SICK scanners: 81.83, 81.91 m

/// The words of a line of a CARMEN log.
class CarmenWords {
  public:
    CarmenWords(std::string_view line, const std::string& name, int number)
        : rest_(line), name_(name), number_(number), begin_(line.data()) {}

    [[nodiscard]] std::string_view word() {
        const std::size_t begin = rest_.find_first_not_of(" \t\r");
        if (begin == std::string_view::npos) return rest_ = {};
        const std::size_t end = std::min(rest_.find_first_of(" \t\r", begin), rest_.size());
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }
    double number(const char* noun) {
        const std::string_view text = word();
        if (text.empty()) fail("the line ends before its " + std::string(noun));
        const std::optional<double> value = parseDouble(text);
        if (!value) fail("`" + std::string(text) + "` is no number: the " + noun, text);
        return *value;
    }
    double within(const char* noun, double lowest, double highest) {
        const double value = number(noun);
        if (!(value >= lowest && value <= highest))
            fail("a " + std::string(noun) + " of " + formatDouble(value) + ", wanted " +
                 formatDouble(lowest) + " to " + formatDouble(highest));
        return value;
    }
    std::size_t count(const char* noun) {
        constexpr double kMost = 1'000'000;
        const double value = within(noun, 0, kMost);
        if (value != std::floor(value)) fail("a " + std::string(noun) + " that is not whole");
        return static_cast<std::size_t>(value);
    }
    Pose2 pose(const char* noun) {
        const double x = within(noun, -kFarthestPlace, kFarthestPlace);
        const double y = within(noun, -kFarthestPlace, kFarthestPlace);
        constexpr double kMostTurns = 1e6;
        return {{x, y}, Angle::radians(within(noun, -kMostTurns, kMostTurns))};
    }
    std::vector<float> ranges(std::size_t count) {
        std::vector<float> values;
        // A claimed count may exceed the line.
        values.reserve(std::min(count, rest_.size() / 2 + 1));
        for (std::size_t k = 0; k < count; ++k)
            values.push_back(static_cast<float>(within("range", 0, kFarthestPlace)));
        return values;
    }
    [[noreturn]] void fail(const std::string& message, std::string_view at = {}) const {
        const int column = at.empty() ? 0 : static_cast<int>(at.data() - begin_) + 1;
        throw FormatError({displayName(name_), number_, column, message});
    }

  private:
    std::string_view rest_;
    const std::string& name_;
    int number_;
    const char* begin_;
};

struct CarmenBeams {
    Angle first, step;
};

/// Returns the bearings of FLASER, which does not state them, as CARMEN guesses them by the number
/// of beams.
CarmenBeams guessedBeams(std::size_t count) {
    constexpr std::size_t kFine = 401;  // a hundred degrees at a quarter
    if (count == kFine) return {Angle::degrees(-50), Angle::degrees(0.25)};
    if (count == 180) return {Angle::degrees(-90), Angle::degrees(1)};    // NOLINT: of 181
    if (count == 360) return {Angle::degrees(-90), Angle::degrees(0.5)};  // NOLINT: of 361
    const double steps = count > 1 ? static_cast<double>(count - 1) : 1;
    return {Angle::degrees(-90), Angle::degrees(180 / steps)};
}

/// A scan with both poses of its line, before it is known what they are.
struct CarmenScan {
    LogScan scan;
    Pose2 laser, robot;
};

Pose3 onPlane(const Pose2& pose) {
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
}

Pose2 inFrameOf(const Pose2& frame, const Pose2& pose) {
    const Vec2 way = pose.position - frame.position;
    const auto [c, s] = cosSin(frame.heading);
    return {{c * way.x + s * way.y, c * way.y - s * way.x}, wrapped(pose.heading - frame.heading)};
}

bool areNear(const Pose2& a, const Pose2& b, double metres) {
    constexpr double kRadians = 0.002;
    return distance(a.position, b.position) <= metres &&
           std::abs(wrapped(a.heading - b.heading).radians()) <= kRadians;
}

class CarmenReader {
  public:
    CarmenReader(std::string_view bytes, const std::string& name)
        : bytes_(bytes), name_(name), budget_(name) {}

    Log read() {
        int number = 0;
        for (std::size_t begin = 0; begin < bytes_.size();) {
            const std::size_t end = std::min(bytes_.find('\n', begin), bytes_.size());
            readLine(bytes_.substr(begin, end - begin), ++number);
            begin = end + 1;
        }
        log_.name = name_;
        log_.format = "carmen";
        resolve();
        finishLog(log_);
        return std::move(log_);
    }

  private:
    void readLine(std::string_view line, int number) {
        CarmenWords words(line, name_, number);
        const std::string_view type = words.word();
        if (type == "FLASER") return readFlaser(words);
        if (type == "ODOM") return readOdometry(words);
        constexpr std::string_view kRobotLaser = "ROBOTLASER";
        if (type.starts_with(kRobotLaser) && parseInteger(type.substr(kRobotLaser.size())))
            return readRobotLaser(words, std::string(type));
    }

    void readFlaser(CarmenWords& words) {
        CarmenScan read;
        read.scan.sensor = "FLASER";
        const std::size_t count = words.count("number of beams");
        if (count == 0) words.fail("a scan without beams");
        const CarmenBeams beams = guessedBeams(count);
        read.scan.first = beams.first;
        read.scan.step = beams.step;
        read.scan.ranges = words.ranges(count);
        read.laser = words.pose("pose of the laser");
        read.robot = words.pose("pose of the robot");
        read.scan.time = words.number("time");
        store(std::move(read));
    }

    void readRobotLaser(CarmenWords& words, std::string sensor) {
        CarmenScan read;
        read.scan.sensor = std::move(sensor);
        static_cast<void>(words.number("laser type"));
        constexpr double kMostRadians = 7;
        read.scan.first = Angle::radians(words.within("start angle", -kMostRadians, kMostRadians));
        static_cast<void>(words.within("field of view", 0, kMostRadians));
        read.scan.step = Angle::radians(words.within("angular step", -kMostRadians, kMostRadians));
        read.scan.max_range = words.within("maximum range", 0, kFarthestPlace);
        static_cast<void>(words.number("accuracy"));
        static_cast<void>(words.number("remission mode"));
        const std::size_t count = words.count("number of beams");
        if (count == 0) words.fail("a scan without beams");
        read.scan.ranges = words.ranges(count);
        const std::size_t remissions = words.count("number of remissions");
        for (std::size_t k = 0; k < remissions; ++k) static_cast<void>(words.number("remission"));
        read.laser = words.pose("pose of the laser");
        read.robot = words.pose("pose of the robot");
        for (const char* noun :
             {"speed", "turn rate", "safety distance", "safety distance", "turn axis"})
            static_cast<void>(words.number(noun));
        read.scan.time = words.number("time");
        store(std::move(read));
    }

    void readOdometry(CarmenWords& words) {
        LogOdometry read{
            .source = "ODOM", .pose = words.pose("pose"), .scans_before = scans_.size()};
        for (const char* noun : {"speed", "turn rate", "acceleration"})
            static_cast<void>(words.number(noun));
        read.time = words.number("time");
        // A filter writes the corrected pose behind each scan, without a time.
        read.begins =
            read.time == 0 && !scans_.empty() && areNear(read.pose, scans_.back().laser, kSame);
        if (read.begins) read.time = scans_.back().scan.time;
        budget_.take(1);
        log_.odometry.push_back(std::move(read));
    }

    void store(CarmenScan read) {
        budget_.take(read.scan.ranges.size());
        scans_.push_back(std::move(read));
    }

    /// Decides what the two poses of a scan are, and which readings are no return.
    void resolve() {
        std::map<std::string, bool> corrected;
        const bool begins_anew = std::any_of(log_.odometry.begin(), log_.odometry.end(),
                                             [](const LogOdometry& each) { return each.begins; });
        std::map<std::string, const CarmenScan*> first;
        std::map<std::string, float> farthest;
        for (const CarmenScan& each : scans_) {
            const CarmenScan* const before = first.emplace(each.scan.sensor, &each).first->second;
            constexpr double kOffset = 0.01;  // metres, of rounded poses
            if (begins_anew || !areNear(inFrameOf(each.robot, each.laser),
                                        inFrameOf(before->robot, before->laser), kOffset))
                corrected[each.scan.sensor] = true;
            float& most = farthest[each.scan.sensor];
            for (const float range : each.scan.ranges) most = std::max(most, range);
        }
        for (CarmenScan& each : scans_) {
            LogScan& scan = each.scan;
            if (corrected[scan.sensor]) {
                scan.poses.corrected = onPlane(each.laser);
                if (!begins_anew) scan.poses.odometry = each.robot;
            } else {
                scan.poses.odometry = each.robot;
                scan.poses.mount = onPlane(inFrameOf(each.robot, each.laser));
            }
            if (scan.max_range <= 0) {
                const float most = farthest[scan.sensor];
                scan.max_range = most >= kCarmenNoReturn ? double{most} : kCarmenNoReturn;
            }
            const auto none = static_cast<float>(scan.max_range);
            for (float& range : scan.ranges)
                if (range >= none) range = std::numeric_limits<float>::infinity();
            log_.scans.push_back(std::move(scan));
        }
    }

    static constexpr double kSame = 1e-6;  // metres

    std::string_view bytes_;
    const std::string& name_;
    LogBudget budget_;
    Log log_;
    std::vector<CarmenScan> scans_;
};

}  // namespace

Log readCarmenLog(std::string_view bytes, const std::string& name) {
    return CarmenReader(bytes, name).read();
}

}  // namespace ispace::reality
