// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_MESSAGES_H
#define TRACKER_MESSAGES_H

#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "clusters.h"

namespace tracker {

/// What a node has found in one scan.
struct Finding {
    double time = 0;  ///< of the scan, by the node's clock, s
    std::string laser;
    std::vector<Cluster> clusters;
};

/// Writes a finding as a line: the time, the laser, and x,y,width,kind of each cluster; m.
inline std::string textOf(const Finding& finding) {
    char number[96];
    std::snprintf(number, sizeof number, "%.6f ", finding.time);
    std::string text = number + finding.laser;
    for (const Cluster& cluster : finding.clusters) {
        std::snprintf(number, sizeof number, " %.3f,%.3f,%.3f,%c", cluster.centre.x(),
                      cluster.centre.y(), cluster.width, cluster.kind == Kind::Leg ? 'L' : 'R');
        text += number;
    }
    return text;
}

/// \throws std::runtime_error for other lines
inline Finding readFinding(const std::string& text) {
    std::istringstream words(text);
    Finding finding;
    words >> finding.time >> finding.laser;
    if (!words) throw std::runtime_error("no finding: " + text);
    std::string word;
    while (words >> word) {
        Cluster cluster;
        char kind = 0;
        if (std::sscanf(word.c_str(), "%lf,%lf,%lf,%c", &cluster.centre.x(), &cluster.centre.y(),
                        &cluster.width, &kind) != 4)
            throw std::runtime_error("no cluster: " + word);
        cluster.surface = cluster.centre;
        cluster.kind = kind == 'R' ? Kind::Robot : Kind::Leg;
        finding.clusters.push_back(cluster);
    }
    return finding;
}

}  // namespace tracker

#endif  // TRACKER_MESSAGES_H
