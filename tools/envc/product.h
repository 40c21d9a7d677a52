// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "envc/options.h"
#include "layout/scene.h"
#include "record/record.h"

namespace ispace {

/// The file that stands beside the product; "" for none.
std::string besideOf(const EnvcOptions& options);

/// Writes the product and what stands beside it. \throws as OutputFile and the format's writer
void writeProduct(const EnvcOptions& options, const Scene& scene, const Document& document,
                  const FoundRooms* found);

/// For large inputs: what is let go of on the way is used again, and not given back to the system,
/// which would have to clear it anew. Large rooms come and go through a few hundred megabytes.
void keepMemory(const std::vector<std::string>& inputs);

}  // namespace ispace
