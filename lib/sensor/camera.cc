// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensor/drawing.h"
#include "sensor/keys.h"
#include "sensor/kind.h"

namespace ispace {

const SensorKind kCameraKind = {
    .keyword = "camera",
    .noun = "camera",
    .help = "camera; bare: fov=45 pixels=640,480",
    .heading_help = "direction of its axis, from +x",
    .device_help = "",
    .sign = SensorSign::Square,
    .add_keys = [](std::vector<KeySpec>& keys) { addPictureKeys(keys, 179); },
    .body =
        [] {
            return lensBox({0.07, 0.06, 0.06}, {0}, 0.022);
        }};

}  // namespace ispace
