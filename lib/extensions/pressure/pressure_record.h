// SPDX-License-Identifier: GPL-3.0-or-later
// The records `floor_sensor`, `seat_sensor` and `load`.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "geom/polygon.h"
#include "geom/pose.h"
#include "record/schema.h"
#include "scene/scene.h"

namespace ispace::pressure {

/// A rectangle of floor with a grid of cells that each measure a force.
struct PressureFloor {
    std::string id;        ///< with the id of the room before it, "ground/f1"
    Pose2 pose;            ///< of its middle
    double length = 0;     ///< along its heading, metres
    double width = 0;      ///< across
    double cell = 0.25;    ///< side of a cell, metres
    double rate = 10;      ///< readings a second
    double threshold = 5;  ///< newtons: cells with less read 0
    double sigma = 0;      ///< standard deviation of a cell's noise, newtons

    /// Most cells of one.
    static constexpr std::size_t kMostCells = 1'000'000;

    /// Numbers of cells along the heading and across; the last ones may reach beyond the edge.
    [[nodiscard]] std::size_t columns() const;
    [[nodiscard]] std::size_t rows() const;
    /// Returns the middle of a cell in the room. Cells are numbered from the corner behind, on the
    /// right, along the heading and then to the left.
    [[nodiscard]] Point2 middleOf(std::size_t index) const;
};

/// A bed, chair or sofa that feels the people on it: those that sit or lie on it by a posture of
/// theirs. A person without one that stands still beside the thing counts as on it, too.
struct PressureSeat {
    std::string id;              ///< with the id of the room before it
    std::vector<Polygon> thing;  ///< its outlines on the floor
    double reach = 0.6;          ///< metres from the thing to the middle of a person on it
    double settle = 2;           ///< seconds without motion until a person is on it
    double rate = 10;            ///< readings a second
    double threshold = 50;       ///< newtons from which it is occupied
    double sigma = 0;            ///< standard deviation of its noise, newtons

    /// Returns the distance of a point from the thing, 0 inside.
    [[nodiscard]] double distanceTo(Point2 point) const;
};

/// What feels and what is felt in a room.
struct PressureScene {
    std::vector<PressureFloor> floors;
    std::vector<PressureSeat> seats;
    std::map<std::string, double> loads;  ///< by the ids of robots and people in the run, kg
};

/// Returns the schemas of the records.
std::vector<Schema> pressureSchemas();

/// Returns the mass of a person without a `load`, kg: 23 kg/m^2 (amid the normal weights of the
/// World Health Organization) times the height squared.
double massOfPerson(double height);
/// Returns that of a robot: 144 kg/m^2 times the radius squared, by which a Pioneer 2-DX of 0.25 m
/// weighs its 9 kg.
double massOfRobot(double radius);

/// Adds the checks of the records: `of` names a thing of the room, or a robot or person.
void addPressureChecks();

/// Which movers loads may be of.
enum class LoadsOf {
    ItsOwn,  ///< those of the scene
    Any      ///< others, too, which have gone to another room; records of a running world that
             ///< contradict each other are left out
};

/// Reads the records of a scene. \param prefix of a room, "ground/", put before ids of sensors
/// \throws FormatError at a record that refers to no thing or mover, and for a grid of too many
/// cells
PressureScene pressureScene(const Scene& scene, const std::string& prefix,
                            LoadsOf movers = LoadsOf::ItsOwn);

}  // namespace ispace::pressure
