// SPDX-License-Identifier: GPL-3.0-or-later
// The program of a node (a DIND): reads the lasers that it owns, finds legs and robots in their
// scans, and sends these to the program that fuses them.
//
//   tracker_node 127.0.0.1:7001 network.3dm n1 --until 60
//
// The layout holds the poses of the lasers. Exit status: 0, 1 no server or layout, 2 usage.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <map>
#include <string>

#include <ispace_client.h>

#include "clusters.h"
#include "geometry.h"
#include "messages.h"

namespace {

constexpr char kUsage[] =
    "usage: tracker_node [HOST:]PORT LAYOUT.3dm NODE [--until SECONDS] [--every SECONDS]\n"
    "Finds people and robots in the scans of a node's lasers, and sends them.\n";

void run(const std::string& server, const std::string& layout, const std::string& id, double until,
         double every) {
    ispace::client::Node node(server, id);
    std::map<std::string, tracker::ClusterFinder> finders;
    for (const tracker::Mount& mount : tracker::readMounts(layout))
        for (const std::string& sensor : node.sensors())
            if (mount.id == sensor)
                finders.emplace(sensor,
                                tracker::ClusterFinder(
                                    mount, ispace::client::LaserSensor(server, sensor).rangeMax()));
    try {
        const double begin = node.time();
        for (long k = 1; begin + static_cast<double>(k) * every <= until; ++k) {
            node.await(begin + static_cast<double>(k) * every);
            for (auto& pair : finders) {
                const auto scan = node.scan<ispace::client::Scan>(pair.first);
                node.send(textOf(tracker::Finding{scan.time, pair.first, pair.second.find(scan)}));
            }
        }
    } catch (const ispace::client::ConnectionError&) {
        // The run is over.
    } catch (const ispace::client::Refused& refused) {
        if (refused.code() != 405) throw;  // likewise
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::string words[3];
    int count = 0;
    double until = std::numeric_limits<double>::infinity(), every = 0.1;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--help" || word == "-h") {
            std::fputs(kUsage, stdout);
            return 0;
        }
        if ((word == "--until" || word == "--every") && i + 1 < argc)
            (word == "--until" ? until : every) = std::atof(argv[++i]);
        else if (count < 3)
            words[count++] = word;
        else
            count = 4;
    }
    if (count != 3 || !(until > 0) || !(every > 0)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const bool has_host = words[0].find(':') != std::string::npos;
    try {
        run(has_host ? words[0] : "127.0.0.1:" + words[0], words[1], words[2], until, every);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tracker_node: %s\n", error.what());
        return 1;
    }
    return 0;
}
