// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces with their pictures as text, JSON and drawing. Areas in m2, densities in pixels a metre,
// angles in degrees.
#pragma once

#include <string>

#include "drawing/drawing.h"
#include "extensions/projection/projector_coverage.h"

namespace ispace::projection {

/// Returns the figures as aligned lines: a table for each projector, and one of all surfaces.
std::string projectionText(const ProjectionReport& projection);

/// Returns the figures as one JSON object and a newline, schema ispace-projection/1.
std::string projectionJson(const ProjectionReport& projection);

/// Draws the flat surfaces that projectors light, unrolled side by side in one scale, each as seen
/// from its front: where they carry pictures, where pictures are too coarse, where shadows fall,
/// and the largest rectangles. \param width of the picture, pixels \throws UsageError for a width
/// that cannot be drawn
Picture projectionPicture(const ProjectionReport& projection, const std::string& title, int width);

}  // namespace ispace::projection
