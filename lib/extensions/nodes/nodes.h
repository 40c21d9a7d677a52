// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/nodes: computers with sensors, clocks and lossy lines: the role NODE of simrun.
// Uses server and below.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "extensions/nodes/node_record.h"
#include "server/client_role.h"

namespace ispace::nodes {

/// Makes the role NODE of a run that has nodes; null without any.
///
/// A program takes a node by `NODE id` (one at a time), reads its sensors by its clock, sends
/// messages to programs that HEAR, and waits for times by AWAIT. With `lockstep=yes` the world
/// takes no step before the node's program has asked for a time beyond it, from the start until
/// that program leaves. In real time the world goes on.
/// \throws FormatError as nodesOf()
std::unique_ptr<RoleService> makeNodes(std::span<const RunRoom> rooms, std::uint64_t seed);

}  // namespace ispace::nodes
