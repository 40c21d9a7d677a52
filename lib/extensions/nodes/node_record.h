// SPDX-License-Identifier: GPL-3.0-or-later
// The record `node`: a computer of the room that owns sensors (a DIND, a distributed intelligent
// network device), and its line to the others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/schema.h"
#include "scene/scene.h"
#include "sim/sim_time.h"

namespace ispace::nodes {

/// A node and its line.
struct Node {
    std::string id;
    std::vector<std::string> sensors = {};  ///< ids that it may read; each has one node at most
    double delay = 0, jitter = 0;           ///< of a message: mean and standard deviation, seconds
    double loss = 0;                        ///< share of messages that are lost
    std::optional<double> rate = {};        ///< messages a second that the line carries; empty: any
    double skew = 0;                        ///< its clock goes faster by this share
    double offset = 0;                      ///< seconds that its clock is ahead at the start
    bool lockstep = false;                  ///< the world waits for its program, see NodeNetwork

    /// Returns the time on its clock: offset + (1 + skew) t, seconds.
    [[nodiscard]] double clock(SimTime time) const { return offset + (1 + skew) * seconds(time); }
    /// Returns the first time of the world at which its clock shows at least this; empty if that
    /// is before the start or beyond kMaxTime.
    [[nodiscard]] std::optional<SimTime> worldTime(double clock) const;
};

/// Returns the schema of the record.
std::vector<Schema> nodeSchemas();

/// Reads the nodes of a scene, in order. \param prefix of a room, "ground/", put before ids
/// \throws FormatError at the record: a sensor that the scene lacks or that another node has, a
/// deviation of a delay without a mean
std::vector<Node> nodesOf(const Scene& scene, const std::string& prefix);

}  // namespace ispace::nodes
