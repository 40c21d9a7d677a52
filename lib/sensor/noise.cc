// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensor/noise.h"

#include <algorithm>

#include "base/number.h"

namespace ispace {

void addNoiseKeys(std::vector<KeySpec>& keys) {
    constexpr double kMax = 1e3;
    keys.push_back({.name = "bias",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "added to each distance measured, with scan --noise (as all of these)",
                    .lower = -kMax,
                    .upper = kMax});
    keys.push_back({.name = "sigma",
                    .type = KeyType::Tuple,
                    .help = "s0,s1,s2: at distance r its standard deviation is s0 + s1 r + s2 r^2",
                    .min_count = 1,
                    .max_count = 3,
                    .lower = -kMax,
                    .upper = kMax});
    keys.push_back({.name = "angle_sigma",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "standard deviation of each beam's bearing",
                    .lower = 0,
                    .upper = 90});
    keys.push_back({.name = "dropout",
                    .type = KeyType::Number,
                    .unit = Unit::Share,
                    .help = "share of the returns that is lost",
                    .lower = 0,
                    .upper = 1});
    keys.push_back({.name = "incidence",
                    .type = KeyType::Tuple,
                    .unit = Unit::Angle,
                    .help = "angles to the normal of the surface: between them a growing share of "
                            "returns is lost, beyond the second all",
                    .min_count = 2,
                    .max_count = 2,
                    .lower = 0,
                    .upper = 90});
    keys.push_back({.name = "resolution",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "distances are whole multiples of this; 0: any",
                    .lower = 0,
                    .upper = kMax});
}

void applyNoise(const Record& record, RangeNoise& noise, Diagnostics& findings) {
    if (record.has("bias")) noise.bias = record.number("bias");
    if (record.has("sigma")) {
        const Tuple& sigma = record.tuple("sigma");
        if (sigma.front() < 0)
            findings.add(record.finding("sigma",
                                        "`sigma`: its first number, the standard deviation "
                                        "close by, is below 0"));
        noise.sigma = {};
        std::copy(sigma.begin(), sigma.end(), noise.sigma.begin());
    }
    if (record.has("angle_sigma")) noise.angle_sigma = record.angle("angle_sigma");
    if (record.has("dropout")) noise.dropout = record.number("dropout");
    if (record.has("resolution")) noise.resolution = record.number("resolution");
    if (record.has("incidence")) {
        const Tuple& incidence = record.tuple("incidence");
        if (incidence[0] > incidence[1])
            findings.add(record.finding(
                "incidence", "`incidence`: " + formatDouble(incidence[0]) +
                                 " degrees, from which on returns get lost, is above " +
                                 formatDouble(incidence[1]) + ", from which on all are"));
        noise.graze_from = Angle::degrees(incidence[0]);
        noise.graze_to = Angle::degrees(incidence[1]);
    }
}

}  // namespace ispace
