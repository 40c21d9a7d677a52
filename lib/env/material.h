// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace ispace {

/// What a surface is made of, as far as pictures and viewers care.
enum class Material {
    Floor,
    FloorDark,
    Wall,
    Wood,
    WoodDark,
    Brick,
    Concrete,
    Metal,
    Fabric,
    Barrier,
    Box,
    Pillar,
    Ceiling,
    Glass,
    Screen,
    Sensor,
    Robot,
    Skin,
    Cloth,
    Mat,
    Mesh,
    View  ///< what a sensor looks at
};

/// How a material looks: colour (linear RGB, opacity), metallic share and roughness.
struct Look {
    const char* name;
    std::array<double, 3> color;
    double opacity, metallic, roughness;
};

const Look& lookOf(Material material);

/// Name of what sensors look at in models: nothing that stands there, so it is left out where a
/// model is read as a mesh.
inline constexpr const char* kViewMaterial = "sensor-view";

}  // namespace ispace
