// SPDX-License-Identifier: GPL-3.0-or-later
// Light of projectors on surfaces: by the solid angle that a surface takes from the lens, and the
// cosine of its slant (J. H. Lambert, Photometria, 1760). Distances count from the lens as a point;
// nearer than a centimetre before it there is no light. Lux, lumens; pure functions, O(1).
//
//     if (const auto beam = projectorBeam(record))
//         if (const auto spot = beam->spotAt(place, normal)) lux += spot->lux;
#pragma once

#include <optional>

#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

/// The light of a `projector`: even over a pyramid about its axis, as a picture throws it.
struct ProjectorBeam {
    Frame3 lens;                     ///< facing along the axis, the picture upright along `up`
    double across = 0, upright = 0;  ///< tangents of half the fields of view
    double lumens = 0;

    /// A point in the beam.
    struct Spot {
        double u = 0, v = 0;  ///< in the picture, (0, 0) its upper left corner, (1, 1) the opposite
        double lux = 0;       ///< of a white picture
    };
    /// Returns the light that falls on a surface with this unit normal, if no body is between;
    /// empty beside the beam and behind the surface.
    [[nodiscard]] std::optional<Spot> spotAt(Point3 place, Vec3 normal) const;
    friend bool operator==(const ProjectorBeam& a, const ProjectorBeam& b);
};

/// Reads the beam of a `projector` record; empty if it is off.
std::optional<ProjectorBeam> projectorBeam(const Record& record);

}  // namespace ispace
