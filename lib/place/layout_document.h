// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "place/arrangement.h"

namespace ispace {

/// What the layout to be written is made of.
struct LayoutParts {
    History history;
    std::string environment_file;  ///< "" if there is none to name
    std::string environment_digest;
    std::string strategy, optimize;
};

/// A `.3dm`: the `environment` record, what `before` (or nothing) holds with its pending sensors
/// placed, the other new sensors, the `result`.
Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement);

}  // namespace ispace
