// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arrange/tried_pose.h"
#include "coverage/coverage.h"
#include "coverage/run_coverage.h"
#include "drawing/drawing.h"

namespace ispace {

/// What the colour of covered floor tells.
enum class MapColor {
    Redundancy,  ///< how many sensors see it
    Sensor,      ///< which one does; where several do, hatched or mixed so that it shows
    Density,     ///< with how many pixels a metre cameras see it, by the classes of the standard
};

/// How a sensor's view is drawn.
enum class FanStyle {
    Contours,  ///< the outline of what it sees (the thesis' "show area")
    Beams,     ///< the beams of lasers, thinned where they would run together; sweeps and other
               ///< sensors as contours
};

struct MapOptions {
    PictureFormat format = PictureFormat::Png;
    int width = 1200;        ///< of PNG and SVG, in pixels
    std::string title = {};  ///< e.g. base name of ENV; "" for none
    MapColor color = MapColor::Redundancy;
    FanStyle fans = FanStyle::Contours;
    /// What a search tried: places in the colours of the best value there, below the sensors.
    std::vector<TriedPose> trace = {};
    /// What the layout saw of a run: ways in colours by the number of sensors that saw them, and
    /// rings where sight was lost; null for none. It outlives the options.
    const RunCoverage* run = nullptr;
};

/// The plan as a picture for a paper: covered floor, walls, objects, each sensor with its id,
/// heading and view, the largest unseen spots, legend, scale bar, the metrics. Returns the bytes of
/// the file; equal input gives equal bytes. Covered floor is drawn from coverage.overlay, whatever
/// the size of the picture sharp, or from cells where there is none. A PDF is to scale: on A4 or
/// A3, the plan at the largest usual scale (1:20, 1:25, 1:50, …) that fits.
///
/// `other`, if not null, is what coverage was compared with (compare()): the colours then tell the
/// indoor floor that both see, this one alone (gained), and the other alone (lost), and the other's
/// sensors are marked as such.
std::string drawCoverageMap(const Scene& scene, const Coverage& coverage, const MapOptions& options,
                            const Coverage* other = nullptr);

}  // namespace ispace
