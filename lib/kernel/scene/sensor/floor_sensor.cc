// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/floor_sensor.h"

#include "scene/sensor/sensor.h"

namespace ispace {

Mat matOf(const Record& record) {
    const Tuple& size = record.tuple("size");
    Mat mat;
    mat.half_length = size[0] / 2;
    mat.half_width = size[1] / 2;
    mat.rate = record.number("rate");
    return mat;
}

Gate gateOf(const Record& record) {
    Gate gate;
    gate.half_width = record.number("width") / 2;
    gate.height = record.number("height");
    gate.rate = record.number("rate");
    return gate;
}

const SensorKind Mat::kKind = {.keyword = "mat", .noun = "mat", .perceives = false};
const SensorKind Gate::kKind = {.keyword = "gate", .noun = "gate", .perceives = false};

}  // namespace ispace
