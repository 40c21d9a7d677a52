// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace ispace::bench {

/// Reads a room; plans of other programs too, if the build reads drawings.
Document readRoom(const std::string& file);

/// share/scenes/NAME, or any other environment, with the devices of share/.
Scene loadScene(const std::string& file);
std::string sceneFile(const std::string& name);
DeviceCatalogue devices();

/// An office floor as big as real ones: columns x rows rooms of 4 m x 5 m along corridors, each
/// with a door gap, a desk, a chair and a round table. Some 108 lines of a slice a room, and 2 000
/// triangles, most of them the chair's.
std::string officeText(int columns, int rows);
Scene officeScene(int columns, int rows);
/// The scene that a text of records describes.
Scene sceneOfText(const std::string& text);
/// Lines of the slice that level fans meet.
std::size_t linesOf(const Scene& scene);
/// A device of share/.
Laser laserOfModel(const std::string& model);
Ranger rangerOfModel(const std::string& model);

/// Text of a building with this many walls or some more, on one floor as deep as wide: corridors
/// with rooms of 4 m x 5 m on their upper side, walls that meet at T junctions, a door in each room
/// (every fourth closed), windows, desks, chairs and pillars. All corridors and the rooms with open
/// doors are one indoor region.
struct Building {
    std::string text;
    std::size_t walls = 0;
    double indoor_area = 0;  ///< square metres
};
Building building(std::size_t walls);
/// Text of a DXF drawing with about as many lines: a square floor of cubicles of 2.5 m, each with a
/// gap of 0.8 m to its neighbours; with `doors` also a leaf and its swing, an arc, in each gap. All
/// are one indoor region. `walls` counts the lines and arcs.
Building drawnCubicles(std::size_t lines, bool doors);

/// A closed surface with bumps, about a metre wide, as it comes from a scan: a globe of `rings`
/// times `sectors` quadrangles, those at the poles triangles.
std::shared_ptr<const TriangleMesh> bumpyGlobe(std::uint32_t rings, std::uint32_t sectors);

/// The map robots made of the floor of Willow Garage, "" if ISPACE_TEST_DATA names no folder with
/// it.
std::string willowMap();

/// Points of the free floor, drawn from a fixed seed: `count` lasers with 1081 beams over 270
/// degrees and 30 m, level at 0.15 m, or at 1.55 m and tilted down by 20 degrees.
std::vector<Sensor> fans(const Scene& scene, std::size_t count, bool level);

}  // namespace ispace::bench
