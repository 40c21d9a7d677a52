// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace ispace {

struct SensorKind;
/// Cameras are read and drawn, but not simulated yet.
extern const SensorKind kCameraKind;

}  // namespace ispace
