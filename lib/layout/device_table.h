// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "layout/devices.h"

namespace ispace {

/// The devices of some keywords for people: a line each with model, kind, name, range, field of
/// view, beams or pixels, rate and confidence, in columns, with a header line; in catalogue order
/// within each keyword.
std::string deviceTable(const DeviceCatalogue& devices, std::span<const std::string_view> kinds);

}  // namespace ispace
