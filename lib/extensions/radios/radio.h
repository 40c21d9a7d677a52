// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/radios: senders and receivers of messages on robots, people, things and walls,
// with ranges, walls and cones. Uses record, scene, trace, server.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/schema.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace::radios {

/// A `radio` record: it sends messages, and receives those of its kind and channel.
struct Radio {
    bool is_infrared = false;
    int channel = 1;
    double range = 10;                ///< metres in free air
    double loss = 6;                  ///< dB that a wall takes from a radio's signal
    double drop = 0;                  ///< share of messages to each receiver that are lost
    Angle fov = Angle::degrees(360);  ///< full angle of the cone about its axis
};

/// \pre the record is a `radio`
Radio radioOf(const Record& record);

/// The carrier of a radio.
struct RadioCarrier {
    std::string id = {};  ///< of a robot or a person; "" if it stands still
    Pose3 pose = {};      ///< in the frame of that carrier, else in the room
};

/// Finds the carrier of a radio, and its pose there. Records of the scene carry it: robots, people
/// and objects, on their tops. \pre `on` names one of the scene, as makeScene() has checked
RadioCarrier radioCarrier(const Scene& scene, const Record& record);

/// Computes how much stronger a signal arrives than the weakest that is received, dB; empty if the
/// message does not arrive.
///
/// A radio's signal falls with the square of the distance, is as strong as the weakest one at the
/// sender's range in free air, and loses the receiver's `loss` in each wall. Infrared light arrives
/// within the range if no wall or thing is between; people and robots let it pass. Each must lie in
/// the cone of the other. \pre both are of a kind and a channel
/// \param mesh of the surfaces that stop light and sound
std::optional<double> signalMargin(const Radio& sender, const Pose3& from, const Radio& receiver,
                                   const Pose3& to, const RayWorld& mesh);

/// Warns of a radio that has no other of its kind and channel.
std::optional<Finding> checkRadio(const Scene& scene, std::size_t record);

/// Returns the schema of `radio`, a placement with the state `channel`.
std::vector<Schema> radioSchemas();

/// Adds the kind of radios, for the program.
void addRadios();

}  // namespace ispace::radios
