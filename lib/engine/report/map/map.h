// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/report/map: maps of coverage, with their legends.
//
// Classes of pixels are those of EN 62676-4:2015 or of IEC 62676-4:2025. Colours of redundancy fall
// in lightness, colours of sensors are Okabe and Ito's; hatches and dashes tell apart in grey.
//
//     const std::string pdf = drawCoverageMap(scene, coverage, {.format = PictureFormat::Pdf});
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arrange/tried_pose.h"
#include "coverage/coverage.h"
#include "drawing/drawing.h"

namespace ispace {

class MapLayer;

/// Meaning of the colour of covered floor.
enum class MapColor {
    Redundancy,  ///< number of sensors that see the floor
    Sensor,      ///< the sensor that sees it; overlaps are hatched or mixed
    Density,     ///< pixels a metre of the best camera, by the classes of EN 62676-4:2015
    Levels,      ///< likewise, by the levels of IEC 62676-4:2025
};

/// Style of a sensor's view.
enum class FanStyle {
    Contours,  ///< the outline of the view (the thesis' "show area")
    Beams,     ///< the beams of lasers, thinned if they would merge; contours for sweeps and other
               ///< sensors
};

/// Stairs, a lift or a shaft to other storeys, on the floor of this one.
struct MapPassage {
    std::string id;
    std::string kind;  ///< its keyword
    /// Of stairs: from the foot's right corner to the head's, its left one, and that of the foot.
    Polygon outline;
};

struct MapOptions {
    PictureFormat format = PictureFormat::Png;
    int width = 1200;        ///< of PNG and SVG, in pixels
    std::string title = {};  ///< e.g. base name of ENV; "" for no title
    MapColor color = MapColor::Redundancy;
    FanStyle fans = FanStyle::Contours;
    /// Colours of redundancy reach at least to so many sensors: maps of one page have one scale,
    /// the largest redundancyScale() of them.
    std::uint32_t redundancy_scale = 0;
    /// Poses that a search tried: positions coloured by the best value there, below the sensors.
    std::vector<TriedPose> trace = {};
    /// What sections of the report draw on the plan, in this order; they outlive the options.
    std::vector<const MapLayer*> layers = {};
    std::vector<MapPassage> passages = {};
};

/// Returns the number of sensors to which the colours of a map by itself reach.
std::uint32_t redundancyScale(const CoverageReport& report);

/// Draws the plan as a picture, as drawCoverageMap() writes it.
Picture coverageMap(const Scene& scene, const Coverage& coverage, const MapOptions& options,
                    const Coverage* other = nullptr);

/// Draws the plan as a picture for a paper: covered floor, walls, objects, each sensor with its id,
/// heading and view, the largest unseen spots, legend, scale bar, and metrics. Returns the bytes of
/// the file; equal input gives equal bytes. Covered floor is drawn from coverage.overlay, sharp at
/// any size, or from cells if there is no overlay. A PDF is to scale: on A4 or A3, the plan at the
/// largest usual scale (1:20, 1:25, 1:50, …) that fits.
///
/// `other`, if not null, is the coverage with which compare() was called: colours then show the
/// indoor floor that both see, only this one (gained), or only the other one (lost), and the
/// sensors of the other are marked.
std::string drawCoverageMap(const Scene& scene, const Coverage& coverage, const MapOptions& options,
                            const Coverage* other = nullptr);

}  // namespace ispace
