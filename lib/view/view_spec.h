// SPDX-License-Identifier: GPL-3.0-or-later
// lib/view: pictures of a room for people: from where one looks, what sensors see drawn into it.
// Uses cover, render, draw and below.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/point.h"

namespace ispace {

/// The view modes of the thesis (sections 3.3.4, 3.4.6 and 3.5.2), and what a camera sees.
enum class ViewMode {
    Bird,         ///< from above, to scale, north up
    FirstPerson,  ///< by the eyes of somebody who stands there
    Omni,         ///< all around from any place, as a panorama of equal angles
    Central,      ///< around a place or a thing, which stays in the middle
    Orbit,        ///< around the whole plan, which fills the picture
    Robot,        ///< from on top of a robot, ahead
    Camera,       ///< through the lens of a camera
};

/// What `--view` says. What is left out has no value.
struct ViewSpec {
    ViewMode mode = ViewMode::Bird;
    std::string name;             ///< fit for a file: "orbit", "robot-r1"
    std::string id;               ///< of what is looked at, or from
    std::optional<Point2> at;     ///< of what is looked at, or from
    std::optional<double> z;      ///< of Omni
    std::optional<double> width;  ///< of Bird, metres
    std::optional<double> distance;
    /// Where the viewer faces; of Central and Orbit where he stands, seen from the middle.
    std::optional<Angle> heading;
    std::optional<Angle> tilt;  ///< up is positive; of Central and Orbit the viewer's elevation
};

/// Reads `MODE[:VALUE,…]`. \throws UsageError
ViewSpec parseView(const std::string& text);

/// "bird[:X,Y[,WIDTH]]", … in the order of ViewMode.
std::vector<std::string> viewForms();

}  // namespace ispace
