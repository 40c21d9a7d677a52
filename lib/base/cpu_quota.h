// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace ispace {

/// Processors that this process may use by the quota of its control group (version 1 or 2) and of
/// those above it, rounded up: what containers and batch systems grant. Nothing without a quota.
/// \param root where `/proc` and `/sys` are; "" is the machine's
std::optional<int> cpuQuota(const std::string& root = "");

}  // namespace ispace
