// SPDX-License-Identifier: GPL-3.0-or-later
// The program that fuses what the nodes of a room send: one set of tracks for all lasers, which it
// tells the run (for its page, record and topics).
//
//   cd share/scenes
//   simrun network.env network.3dm --clock fast --until 60 --noise --record run --port-file port &
//   for n in n1 n2 n3; do tracker_node $(cat port) network.3dm $n & done
//   tracker_fusion $(cat port) hub
//   coverage --run run --tracks run/tracks.csv --truths people
//
// Messages come late, out of order, or never. Findings wait for `--wait` seconds, so that those of
// one moment from several nodes are taken together and in order; what comes later still is left
// out, and counted at the end. Exit status: 0, 1 no server, 2 usage.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <ispace_client.h>

#include "joint_tracker.h"
#include "messages.h"

namespace {

constexpr char kUsage[] =
    "usage: tracker_fusion [HOST:]PORT NODE [--until SECONDS] [--every SECONDS] [--wait SECONDS]\n"
    "Fuses what nodes send into one set of tracks, and tells them to simrun.\n";

struct Task {
    std::string server, node;
    double until = std::numeric_limits<double>::infinity(), every = 0.1, wait = 0.1;
};

class Fusion {
  public:
    explicit Fusion(const Task& task) : task_(task), node_(task.server, task.node) { node_.hear(); }

    void run() {
        try {
            const double begin = node_.time();
            for (long k = 1; begin + static_cast<double>(k) * task_.every <= task_.until; ++k)
                cycle(node_.await(begin + static_cast<double>(k) * task_.every));
        } catch (const ispace::client::ConnectionError&) {
            // The run is over.
        } catch (const ispace::client::Refused& refused) {
            if (refused.code() != 405) throw;  // likewise
        }
        std::printf("%ld findings fused, %ld too late\n", fused_, late_);
    }

  private:
    /// Clocks of nodes differ a little: scans within this time are of one moment.
    static constexpr double kMoment = 0.02;  // s

    void cycle(double now) {
        ispace::client::NodeMessage message;
        while (node_.receive(message)) {
            const tracker::Finding finding = tracker::readFinding(message.text);
            if (finding.time <= done_)
                ++late_;
            else
                waiting_.emplace(finding.time, finding);
        }
        while (!waiting_.empty() && waiting_.begin()->first <= now - task_.wait) fuse();
    }

    /// Takes the findings of the first moment.
    void fuse() {
        const double time = waiting_.begin()->first;
        std::vector<std::vector<tracker::Cluster>> seen;
        for (auto next = waiting_.begin(); next != waiting_.end() && next->first < time + kMoment;
             next = waiting_.erase(next)) {
            seen.push_back(next->second.clusters);
            done_ = next->first;
            ++fused_;
        }
        tracker_.update(time, seen);
        for (const tracker::Track& track : tracker_.tracks())
            node_.track(std::to_string(track.id()), track.place().x(), track.place().y(), time,
                        track.kind() == tracker::Kind::Robot ? "robot" : "person");
    }

    const Task& task_;
    ispace::client::Node node_;
    tracker::JointTracker tracker_;
    std::multimap<double, tracker::Finding> waiting_;
    double done_ = -1;
    long fused_ = 0, late_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    Task task;
    bool is_wrong = false;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--help" || word == "-h") {
            std::fputs(kUsage, stdout);
            return 0;
        }
        double* const value = word == "--until"   ? &task.until
                              : word == "--every" ? &task.every
                              : word == "--wait"  ? &task.wait
                                                  : nullptr;
        if (value && i + 1 < argc)
            *value = std::atof(argv[++i]);
        else if (task.server.empty())
            task.server = word.find(':') == std::string::npos ? "127.0.0.1:" + word : word;
        else if (task.node.empty())
            task.node = word;
        else
            is_wrong = true;
    }
    if (is_wrong || task.node.empty() || !(task.until > 0) || !(task.every > 0) ||
        !(task.wait >= 0)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    try {
        Fusion(task).run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tracker_fusion: %s\n", error.what());
        return 1;
    }
    return 0;
}
