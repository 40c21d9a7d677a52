// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "layout/scene.h"
#include "layout/sensor_spec.h"
#include "sensor/kind.h"

namespace ispace {

/// Most sensors of a group whose number is for the search to find.
constexpr int kMostOpen = 1000;

/// Sensors that are alike, to be placed: one of the scene without a place, or those of one
/// --sensor.
struct SensorGroup {
    Record record;  ///< without place
    SensorModel model;
    std::string id;           ///< of one that has one; else the next free ones of its keyword
    bool is_pending = false;  ///< of the scene; else new
    int most = 1;
};

/// All sensors to be placed: those the scene has without place, then `added`. `open`: of an added
/// one without count the search finds the number, up to kMostOpen.
/// \throws UsageError if an added record has a place or an id that is taken, FormatError as laserOf
std::vector<SensorGroup> groupsToPlace(const Scene& scene, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open);

/// The layout with the places of its sensors taken away, but for those that one of the globs names
/// and for those that ride on something: so they are placed anew.
/// \throws UsageError for a glob that names no sensor with a place
Document withoutPlaces(const Document& layout, std::span<const std::string> fixed);

/// Sensors that choose from the same candidates: equal figures, mounted alike.
struct SensorClass {
    SensorModel model;
    Record record;   ///< of the first of them
    std::string id;  ///< names it in messages and seeds its random places
    double cost = 1;
    int most = 0;                          ///< of all its groups
    std::vector<std::size_t> groups = {};  ///< in their order
};

/// The kinds of these groups, in the order in which they first come.
std::vector<SensorClass> kindsOf(const std::vector<SensorGroup>& groups);

/// The kind that a group is of. \pre it is of one
std::size_t kindOf(const std::vector<SensorClass>& kinds, std::size_t group);

/// True for what covers floor only together with others: receivers.
inline bool isPartial(const SensorModel& model) { return kindOf(model).together > 1; }

}  // namespace ispace
