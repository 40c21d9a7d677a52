// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/pressure: floors, beds and chairs that feel weights. Uses server and below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "extensions/pressure/pressure_record.h"
#include "scene/bodies.h"
#include "sim/world.h"

namespace ispace::pressure {

/// A disc on the floor that bears a weight evenly: a foot, or a wheel.
struct FootContact {
    Point2 center;
    double radius = 0;   ///< metres
    double newtons = 0;  ///< by all of it
};

/// Returns the feet of a person. They are where all sensors see the legs meet the floor. Standing,
/// each bears half of the weight; walking, the foot that goes back bears it, all of it in the
/// middle of a step and half when the other foot comes down. \param mass kg
std::vector<FootContact> feetOf(double height, double mass, const RobotStatus& status);
/// Returns where a person that sits or lies bears on the floor, or on the thing below it: lying on
/// the floor in discs along its trunk, head and limbs, by their volumes; else in one below its
/// trunk. \param figure of a person that does not walk
std::vector<FootContact> restingContacts(const PersonFigure& figure, double mass,
                                         const Pose2& pose);
/// Returns the wheels of a robot: two at 0.7 of the radius to the sides, which bear 40 % each, and
/// a castor at 0.7 of it behind.
std::vector<FootContact> wheelsOf(double radius, double mass, const RobotStatus& status);

/// A reading of a floor or a seat.
struct PressureReading {
    std::int64_t number = 0;  ///< since the start of the run, from 0
    SimTime time{};
    std::map<std::size_t, double> cells = {};  ///< of a floor: newtons by index, those above 0
    double newtons = 0;                        ///< in all
    bool is_occupied = false;

    [[nodiscard]] double kilograms() const;
};

/// Reads a floor. Contacts press the cells in which each of 64 even parts of them lies; parts
/// beyond the edge do not press. \param noise seed of the run; null: exact
PressureReading readFloor(const PressureFloor& floor, std::span<const FootContact> contacts,
                          std::int64_t number, const std::uint64_t* noise);

/// The floors and seats of a world, and where people are on them.
class PressureField {
  public:
    /// The world must outlive it. \throws FormatError as pressureScene()
    PressureField(const World& world, std::string prefix);

    /// Reads the world after a step. Reads the records again after a change; a record that it does
    /// not understand then leaves all as it was.
    void observe();

    /// Returns the loads of this room.
    [[nodiscard]] const std::map<std::string, double>& loads() const { return scene_.loads; }
    /// Sets those of other rooms, from which robots and people may come.
    void expectVisitors(std::map<std::string, double> loads) { visitors_ = std::move(loads); }

    [[nodiscard]] const std::vector<PressureFloor>& floors() const { return scene_.floors; }
    [[nodiscard]] const std::vector<PressureSeat>& seats() const { return scene_.seats; }
    /// Return what a floor or a seat feels now. \param number of the reading, for its noise
    [[nodiscard]] PressureReading read(const PressureFloor& floor, std::int64_t number) const;
    [[nodiscard]] PressureReading read(const PressureSeat& seat, std::int64_t number) const;

  private:
    void findContacts();
    void readPostures();
    [[nodiscard]] std::optional<double> massOf(const std::string& id) const;

    const World* world_;
    std::string prefix_;
    std::int64_t changes_ = 0;
    PressureScene scene_;
    std::set<std::string> postured_;          // people whose record says how they hold their body
    std::map<std::string, double> visitors_;  // kg
    struct Stay {
        SimTime since;
        Point2 place;
        std::string rest;  // of a person that sits or lies
    };
    std::map<std::string, Stay> stays_;       // of movers that stand still
    std::vector<FootContact> contacts_;       // on the floor
    std::map<std::string, double> on_seats_;  // kg by seat
};

}  // namespace ispace::pressure
