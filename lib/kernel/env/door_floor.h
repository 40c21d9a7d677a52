// SPDX-License-Identifier: GPL-3.0-or-later
// The floor in front of doors as outlines: zones around doors (zone.h), and the floor where people
// who come in face a camera. Metres, in the frame of the environment.
//
//     const DoorFloor floor(environment);
//     for (const Doorway& door : doorwaysOf(environment)) draw(floor.around(door, 1.5));
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "env/zone.h"
#include "geom/polygon.h"

namespace ispace {

/// The floor at the doors of a room.
///
/// A point belongs to a door if it is within a distance of the door's opening, and no wall stands
/// between it and the nearest point of the opening: of the room behind a wall beside the door it
/// does not. Of walls that are drawn by their faces, as those of IFC, the opening reaches from face
/// to face. Doors in the walls, open or shut, hide nothing; windows do, and so do walls whose
/// lower edge is below the knee, however low they are.
class DoorFloor {
  public:
    /// O(n log n) in the walls.
    explicit DoorFloor(const Environment& environment);

    /// Returns the outline, counter-clockwise. Rounded ends have 16 chords a quarter circle.
    /// Without walls about the door it is floorAround(). Rays pass the ends and crossings of up to
    /// 100 wall lines within the distance at 0.1 micrometres on either side: O(n²) for n lines that
    /// cross now and then. Beyond that the outline follows walls by rays along the chords alone,
    /// and takes O(n). Corners within 10 micrometres of each other are one. Thread-safe.
    [[nodiscard]] Polygon around(const Doorway& of, double distance) const;

  private:
    /// A wall line in which a door is.
    struct Face {
        Segment2 jambs;
        double thickness = 0;
    };
    [[nodiscard]] Doorway throughWall(const Doorway& door) const;

    std::vector<Segment2> walls_;                               ///< without their doorways
    std::unordered_map<std::string, std::vector<Face>> faces_;  ///< by the id of the door
};

}  // namespace ispace
