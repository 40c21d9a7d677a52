// SPDX-License-Identifier: GPL-3.0-or-later
// Tracks people and robots by the lasers of a room: background subtraction, legs and robots as
// clusters, Kalman filters, and two ways to assign clusters to tracks. Each laser on its own with
// the nearest neighbour, as in the thesis, confuses people that meet; all lasers together with
// global nearest neighbour do not.
//
//   cd share/scenes
//   simrun tracking.env walkers.3dm --clock step --listen 127.0.0.1:7001 --record run &
//   sleep 1
//   tracker 127.0.0.1:7001 walkers.3dm --until 60 -o tracks.csv
//   kill $!; wait
//   python3 ../examples/tracker/judge_tracks.py tracks.csv run
//
// The layout holds the poses of the lasers. tracks.csv holds a row for each track and scan:
// t,source,track,kind,x,y, where the source is the laser's id or `joint`. With `--clock step` the
// tracker advances the world, and each run is the same; with `--clock real` it reads the lasers'
// streams, one scan each in turn: lasers of different rates drift apart. Exit status: 0, 1 no
// server or layout, 2 usage, 3 if simrun ends before the time of --until.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <ispace_client.h>

#include "clusters.h"
#include "geometry.h"
#include "joint_tracker.h"
#include "separate_tracker.h"

namespace {

struct Task {
    std::string server, layout, output;
    double until = std::numeric_limits<double>::infinity();  // s of the world
    bool help = false;
};

constexpr char kUsage[] =
    "usage: tracker [HOST:]PORT LAYOUT.3dm [--until SECONDS] [-o FILE]\n"
    "Tracks people and robots by the lasers of the layout, in a running simrun.\n";

/// \return whether it is a number alone
bool readNumber(const char* word, double& number) {
    char* end = nullptr;
    number = std::strtod(word, &end);
    return end != word && *end == '\0';
}

bool parse(int argc, char** argv, Task& task) {
    std::vector<std::string> words;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "-o" && i + 1 < argc) {
            task.output = argv[++i];
        } else if (word == "--until" && i + 1 < argc) {
            if (!readNumber(argv[++i], task.until)) return false;
        } else if (word == "--help" || word == "-h") {
            task.help = true;
        } else {
            words.push_back(word);
        }
    }
    if (task.help) return true;
    if (words.size() != 2 || !(task.until > 0)) return false;
    task.server = words[0].find(':') == std::string::npos ? "127.0.0.1:" + words[0] : words[0];
    task.layout = words[1];
    return true;
}

/// A laser, its clusters, and its tracker alone.
struct Eye {
    Eye(const std::string& server, const tracker::Mount& mount)
        : laser(server, mount.id), finder(mount, laser.rangeMax()) {}

    ispace::client::LaserSensor laser;
    tracker::ClusterFinder finder;
    tracker::SeparateTracker alone;
};

class Program {
  public:
    explicit Program(const Task& task) : task_(task), world_(task.server) {
        for (const tracker::Mount& mount : tracker::readMounts(task.layout))
            eyes_.emplace_back(new Eye(task.server, mount));
        by_steps_ = world_.clock() == "step";
        for (const auto& eye : eyes_)
            if (!by_steps_) eye->laser.stream();
        file_ = task.output.empty() ? stdout : std::fopen(task.output.c_str(), "w");
        if (!file_) throw std::runtime_error("cannot write " + task.output);
        std::fprintf(file_, "t,source,track,kind,x,y\n");
    }
    ~Program() {
        if (file_ && file_ != stdout) std::fclose(file_);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// \return whether it has come to the time that was asked for, if one was
    bool run() {
        try {
            while (cycle()) {
            }
        } catch (const ispace::client::ConnectionError&) {
            // The run is over.
        }
        if (std::isinf(task_.until) || time_ >= task_.until) return true;
        std::fprintf(stderr,
                     "tracker: simrun has ended before --until %g: the last scan is of %.3f s\n",
                     task_.until, time_);
        return false;
    }

  private:
    /// One scan of each laser.
    /// \return whether there is time left
    bool cycle() {
        if (by_steps_) {
            const long steps = std::lround(1 / (eyes_.front()->laser.rate() * world_.dt()));
            if (world_.step(steps) < steps) return false;
        }
        std::vector<std::vector<tracker::Cluster>> seen;
        for (const auto& eye : eyes_) {
            const ispace::client::Scan scan = by_steps_ ? eye->laser.scan() : eye->laser.next();
            time_ = scan.time;
            seen.push_back(eye->finder.find(scan));
            eye->alone.update(time_, seen.back());
            write(time_, eye->laser.id(), eye->alone.tracks());
        }
        joint_.update(time_, seen);
        write(time_, "joint", joint_.tracks());
        return time_ < task_.until;
    }

    void write(double time, const std::string& source, const tracker::Tracks& tracks) {
        for (const tracker::Track& track : tracks)
            std::fprintf(file_, "%.3f,%s,%d,%s,%.3f,%.3f\n", time, source.c_str(), track.id(),
                         track.kind() == tracker::Kind::Robot ? "robot" : "person",
                         track.place().x(), track.place().y());
        if (file_ == stdout) std::fflush(file_);
    }

    const Task& task_;
    ispace::client::World world_;
    std::vector<std::unique_ptr<Eye>> eyes_;
    tracker::JointTracker joint_;
    bool by_steps_ = false;
    double time_ = 0;  // s, of the last scan
    std::FILE* file_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) try {
    Task task;
    if (!parse(argc, argv, task)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    if (task.help) {
        std::fputs(kUsage, stdout);
        return 0;
    }
    return Program(task).run() ? 0 : 3;
} catch (const std::exception& error) {
    std::fprintf(stderr, "tracker: %s\n", error.what());
    return 1;
}
