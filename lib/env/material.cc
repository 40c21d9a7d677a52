// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/material.h"

#include <cstddef>

namespace ispace {

const Look& lookOf(Material material) {
    // In the order of the enumerators.
    static constexpr Look kLooks[] = {
        {"floor", {0.62, 0.58, 0.50}, 1, 0, 0.9},
        {"floor-dark", {0.12, 0.12, 0.13}, 1, 0, 0.9},
        {"wall", {0.80, 0.80, 0.76}, 1, 0, 0.9},
        {"wood", {0.45, 0.26, 0.12}, 1, 0, 0.7},
        {"wood-dark", {0.16, 0.08, 0.04}, 1, 0, 0.7},
        {"brick", {0.42, 0.11, 0.07}, 1, 0, 0.95},
        {"concrete", {0.38, 0.38, 0.36}, 1, 0, 0.95},
        {"metal", {0.55, 0.56, 0.58}, 1, 0.4, 0.4},
        {"fabric", {0.07, 0.15, 0.35}, 1, 0, 1},
        {"barrier", {0.70, 0.16, 0.03}, 1, 0, 0.8},
        {"box", {0.52, 0.36, 0.18}, 1, 0, 0.9},
        {"pillar", {0.50, 0.48, 0.44}, 1, 0, 0.9},
        {"ceiling", {0.88, 0.88, 0.88}, 1, 0, 0.95},
        {"glass", {0.55, 0.75, 0.80}, 0.35, 0, 0.1},
        {"screen", {0.90, 0.90, 0.90}, 1, 0, 0.6},
        {"sensor", {0.02, 0.02, 0.03}, 1, 0, 0.5},
        {"robot", {0.45, 0.02, 0.02}, 1, 0, 0.5},
        {"skin", {0.60, 0.33, 0.22}, 1, 0, 0.8},
        {"cloth", {0.05, 0.09, 0.22}, 1, 0, 1},
        {"mat", {0.08, 0.22, 0.12}, 1, 0, 1},
        {"mesh", {0.42, 0.44, 0.48}, 1, 0, 0.8},
        {kViewMaterial, {0.05, 0.25, 0.80}, 0.15, 0, 1},
    };
    return kLooks[static_cast<std::size_t>(material)];
}

}  // namespace ispace
