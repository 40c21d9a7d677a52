// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of a fixed camera by people as marks: lasers tell where they stand, pictures how they
// look.
//
// Lens and size of the camera are those of its record, and clocks of pictures and scans have to
// agree: a person walks 14 mm in 10 ms. Draws have a fixed seed, so that equal input gives equal
// poses.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "extensions/calibration/picture_people.h"
#include "scene/sensor/sensor.h"

namespace ispace::calibration {

/// A picture, and where lasers saw people at its time.
struct PictureMoment {
    std::vector<Point2> people;
    std::vector<PictureBody> bodies;
};

/// Height of people, metres.
struct PeopleHeight {
    double mean = 1.75, sigma = 0.1;
};

/// The pose of a fixed camera, estimated from the people that lasers and its pictures show.
struct CameraFit {
    Pose3 pose;
    /// Of the position (m) and of a rotation about the axes of the room (rad).
    std::array<std::array<double, 6>, 6> covariance = {};
    std::size_t pictures = 0;  ///< with a person that both see
    double pixels = 0;         ///< robust standard deviation of the outlines about the model's
    PeopleHeight height;       ///< as estimated, together with the pose
};

/// Estimates position, heading, tilt and roll of a camera with known lens: the outlines of people
/// in its pictures against those of the body that this library simulates (humanParts()), standing
/// where lasers see its legs. By maximum likelihood with robust weights (Levenberg and Marquardt);
/// the people's height is estimated, too, as it is only known by the size of legs.
///
/// The start needs no pose: it is the direct linear solution for points in a plane, the heads, on
/// which most pictures with one person agree (RANSAC).
/// \throws FormatError without a file: too few pictures with people, outlines that no pose
///         explains, ways that do not determine the pose
CameraFit fitToPictures(const Sensor& camera, std::span<const PictureMoment> moments,
                        const PeopleHeight& height);

}  // namespace ispace::calibration
