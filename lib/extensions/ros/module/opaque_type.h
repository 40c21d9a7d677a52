// SPDX-License-Identifier: GPL-3.0-or-later
// A type of Cyclone DDS whose messages are bytes that are encoded already.
#pragma once

#include <string>
#include <string_view>

#include "extensions/ros/module/dds_participant.h"

struct ddsi_sertype;
struct ddsi_serdata;

namespace ispace::ros {

/// Largest message that is accepted from peers.
constexpr std::size_t kMaxDdsMessage = std::size_t{1} << 18U;

/// Returns a new keyless type in XCDR1, for dds_create_topic_sertype().
ddsi_sertype* newOpaqueType(const std::string& name);
/// Returns a new message with its head, for dds_writecdr().
ddsi_serdata* newOpaqueMessage(const ddsi_sertype* type, std::string_view bytes);
/// Returns a message of dds_takecdr().
DdsMessage messageOf(const ddsi_serdata* message);

}  // namespace ispace::ros
