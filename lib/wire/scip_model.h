// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sensor/laser.h"

namespace ispace {

/// What a laser says of itself in SCIP 2.0, and how its ranges become numbers. Steps of a turn
/// count counter-clockwise; `front` is that of bearing 0, the first beam is step `first`.
///
/// Figures of the models are those that devices report, as public logs of `PP` have them:
/// urg_library's and MRPT's documentation, Hokuyo's SCIP 2.0 specification (URG-04LX). A laser
/// without a model of Hokuyo's is described by its own keys.
struct ScipModel {
    std::string name, product;
    int min_mm = 0, max_mm = 0;
    int turn = 0;  ///< steps of 360 degrees
    int first = 0, last = 0, front = 0;
    int rpm = 0;
    /// Numbers in place of a distance: nothing in range; nearer than min_mm; steps without beam.
    int none = 0, near = 0, unused = 0;
    bool has_intensity = false;
    bool has_echoes = false;  ///< knows HD, HE, ND and NE

    /// What keeps a laser from being one of these ("360 degrees are no whole number of steps"), or
    /// "".
    static std::string refusal(const Laser& laser);
    /// \pre there is no refusal
    static ScipModel of(const Laser& laser);

    /// Millimetres, or the number in place of them; `range` in metres, +infinity for none.
    [[nodiscard]] int number(float range) const;
    /// Of the steps [start, end], merged `cluster` at a time to the least of them that is a
    /// distance. \param ranges of the beams
    [[nodiscard]] std::vector<int> numbers(const std::vector<float>& ranges, int start, int end,
                                           int cluster) const;
    [[nodiscard]] bool isDistance(int number) const { return number >= min_mm && number <= max_mm; }
};

}  // namespace ispace
