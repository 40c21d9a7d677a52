// SPDX-License-Identifier: GPL-3.0-or-later
// Services that nodes ask about parameters (rcl_interfaces).
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sense/formats/cdr.h"

namespace ispace {
class ServerState;
}

namespace ispace::ros {

/// A service of the node that answers at once: those by which nodes list and describe parameters.
struct RosQuery {
    std::string_view name, type;  ///< "/simrun/list_parameters", "rcl_interfaces/srv/..."
    /// Writes the answer. \throws FormatError for a request that ends too early
    void (*answer)(CdrReader& request, ServerState& state, CdrWriter& out);
};
std::span<const RosQuery> rosQueries();

/// Reads the request of a service that sets parameters, see rcl_interfaces/srv/SetParameters: names
/// and values. \throws FormatError for a request that ends too early
std::vector<std::pair<std::string, nlohmann::json>> readParameters(CdrReader& request);
/// Writes a rcl_interfaces/msg/SetParametersResult. \param refusal "" if the parameter is set
void writeSetResult(const std::string& refusal, CdrWriter& out);

}  // namespace ispace::ros
