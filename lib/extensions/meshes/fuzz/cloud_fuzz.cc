// SPDX-License-Identifier: GPL-3.0-or-later
// Point clouds (PCD, LAS, PLY): the points alone, and the plan that they show.
#include <cmath>

#include "extensions/meshes/cloud_file.h"
#include "extensions/meshes/meshes.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    if (!meshes::isPointCloud(bytes)) return;
    Box2 bounds;
    meshes::CloudFile(bytes, "cloud").forEach([&](Point3 p) {
        require(!std::isnan(p.x) && !std::isnan(p.y) && !std::isnan(p.z), "a coordinate is NaN");
        bounds.add({p.x, p.y});
    });
    // Millions of empty cells take a second and show no other paths.
    constexpr double kMaxWidth = 100;
    if (!(bounds.width() < kMaxWidth && bounds.depth() < kMaxWidth)) return;
    ImportOptions options;
    options.slice_walls = 0.5;
    options.slice_top = 1.5;
    options.resolution = 0.25;
    tryPlan(meshes::readPointCloud, bytes, "cloud", options);
}
