// SPDX-License-Identifier: GPL-3.0-or-later
// Identities of samples as RTPS carries them beside the content (DDS-RPC 1.0, 7.8.2): Cyclone DDS
// 0.10 neither tells those of requests nor sends those of answers.
#pragma once

#include <optional>
#include <string>

#include "extensions/ros/module/dds_participant.h"

struct ddsi_domaingv;
struct nn_rdata;

namespace ispace::ros {

/// Returns the identity that an answer to a received request has to name: the caller's reader of
/// answers and the number of the request. Empty if the request names no reader.
/// \param first its first fragment, as Cyclone holds it
std::optional<DdsRequest> requestOf(const nn_rdata& first);

/// Returns an answer as Cyclone is to write it: its parameters in RTPS, then the message.
std::string withRequest(const DdsRequest& request, std::string_view message);
/// Longest result of withRequest(): larger ones would be sent in fragments.
constexpr std::size_t kMaxWithRequest = 14'000;

/// Makes a domain declare the parameters of withRequest() as such when it sends them; Cyclone sends
/// them as the beginning of the content.
void declareRequests(ddsi_domaingv* domain);

}  // namespace ispace::ros
