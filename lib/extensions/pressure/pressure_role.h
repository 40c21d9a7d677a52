// SPDX-License-Identifier: GPL-3.0-or-later
// Floors and seats of a run that programs read and watch.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "extensions/pressure/pressure.h"
#include "server/client_role.h"

namespace ispace::pressure {

/// Makes the role FLOOR of a run that has floors or seats which feel weights; null without any.
///
/// Programs, any number of them, take it by `FLOOR GLOB` for the sensors that match, read them
/// (READ), and hear all of their readings (WATCH). Each sensor has the states `occupied` and
/// `weight`, in whole kilograms, as events of the run.
/// \throws FormatError as pressureScene()
std::unique_ptr<RoleService> makePressure(std::span<const RunRoom> rooms, std::uint64_t seed);

}  // namespace ispace::pressure
