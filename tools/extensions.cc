// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of extensions: the folders of lib/extensions that CMake builds (ISPACE_EXTENSIONS),
// in the order of
// `--help`.
#include "extensions.h"

#include <string_view>
#include <vector>

#include "io/importers.h"
#include "record/missing_keywords.h"
#include "scene/placement_schemas.h"

#ifdef ISPACE_HAS_APPLIANCES
#include "extensions/appliances/appliance.h"
#include "extensions/appliances/meter_role.h"
#endif
#ifdef ISPACE_HAS_BUMPERS
#include "extensions/bumpers/bumper.h"
#endif
#ifdef ISPACE_HAS_CAD
#include "extensions/cad/cad.h"
#endif
#ifdef ISPACE_HAS_CALIBRATION
#include "extensions/calibration/calibrate.h"
#endif
#ifdef ISPACE_HAS_CURTAINS
#include "extensions/curtains/curtain.h"
#endif
#ifdef ISPACE_HAS_DOORCOUNTERS
#include "extensions/doorcounters/doorcounter.h"
#endif
#ifdef ISPACE_HAS_EVENNESS
#include "extensions/evenness/even_objective.h"
#endif
#ifdef ISPACE_HAS_EXPECT
#include "extensions/expect/expectations.h"
#endif
#ifdef ISPACE_HAS_GAZEBO
#include "extensions/gazebo/gazebo.h"
#endif
#ifdef ISPACE_HAS_HEADS
#include "extensions/heads/head.h"
#include "extensions/heads/head_role.h"
#endif
#ifdef ISPACE_HAS_JUDGE
#include "extensions/judge/judge.h"
#endif
#ifdef ISPACE_HAS_LEARNING
#include "extensions/learning/learning.h"
#endif
#ifdef ISPACE_HAS_LEDS
#include "extensions/leds/led.h"
#endif
#ifdef ISPACE_HAS_LOCKS
#include "extensions/locks/lock.h"
#include "extensions/locks/lock_role.h"
#endif
#ifdef ISPACE_HAS_MAPS
#include "extensions/maps/maps.h"
#endif
#ifdef ISPACE_HAS_MEMORY
#include "extensions/memory/memory.h"
#endif
#ifdef ISPACE_HAS_MQTT
#include "extensions/mqtt/mqtt_options.h"
#endif
#ifdef ISPACE_HAS_NAVIGATION
#include "extensions/navigation/navigation.h"
#endif
#ifdef ISPACE_HAS_NODES
#include "extensions/nodes/nodes.h"
#endif
#ifdef ISPACE_HAS_POSTURES
#include "extensions/postures/posture.h"
#endif
#ifdef ISPACE_HAS_PRESSURE
#include "extensions/pressure/pressure_role.h"
#include "extensions/pressure/pressure_scan.h"
#endif
#ifdef ISPACE_HAS_PROJECTION
#include "extensions/projection/projection_options.h"
#endif
#ifdef ISPACE_HAS_RADIOS
#include "extensions/radios/radio.h"
#include "extensions/radios/radio_role.h"
#endif
#ifdef ISPACE_HAS_REALITY
#include "extensions/reality/reality.h"
#endif
#ifdef ISPACE_HAS_ROS
#include "extensions/ros/ros_options.h"
#endif
#ifdef ISPACE_HAS_TRACKING
#include "extensions/tracking/track_objective.h"
#endif
#ifdef ISPACE_HAS_WEB
#include "extensions/web/web_options.h"
#endif
#ifdef ISPACE_HAS_WEBOTS
#include "extensions/webots/webots.h"
#endif
#ifdef ISPACE_HAS_WIRE
#include "extensions/wire/wire_options.h"
#endif

namespace ispace {

namespace {

/// What an extension would bring that this build lacks: an option of a tool, a record or a format.
struct MissingOffer {
    std::string_view extension, owner, name;
};

const std::vector<MissingOffer>& missingOffers() {
    static const std::vector<MissingOffer> offers = {
#include "missing_offers.inc"
    };
    return offers;
}

/// Adds the formats and records that extensions read. Returns true.
bool addFormats() {
#ifdef ISPACE_HAS_APPLIANCES
    addSceneSchemas(applianceSchemas());
    addAppliances();
#endif
#ifdef ISPACE_HAS_BUMPERS
    addSceneSchemas(bumperSchemas());
    addBumpers();
#endif
#ifdef ISPACE_HAS_CAD
    addImporters(cadImporters());
#endif
#ifdef ISPACE_HAS_CALIBRATION
    addImporters(calibrationImporters());
#endif
#ifdef ISPACE_HAS_CURTAINS
    addSceneSchemas(curtainSchemas());
    addCurtains();
#endif
#ifdef ISPACE_HAS_DOORCOUNTERS
    addDoorCounters();
#endif
#ifdef ISPACE_HAS_GAZEBO
    addImporters(gazeboImporters());
#endif
#ifdef ISPACE_HAS_HEADS
    addSceneSchemas(headSchemas());
    addHeads();
#endif
#ifdef ISPACE_HAS_LEDS
    addSceneSchemas(ledSchemas());
    addLeds();
#endif
#ifdef ISPACE_HAS_LOCKS
    addLocks();
#endif
#ifdef ISPACE_HAS_MAPS
    addImporters(mapImporters());
#endif
#ifdef ISPACE_HAS_MEMORY
    addSceneSchemas(volumeSchemas());
#endif
#ifdef ISPACE_HAS_NODES
    addSceneSchemas(nodeSchemas());
#endif
#ifdef ISPACE_HAS_POSTURES
    addPostures();
#endif
#ifdef ISPACE_HAS_PRESSURE
    addSceneSchemas(pressureSchemas());
    addPressureChecks();
#endif
#ifdef ISPACE_HAS_RADIOS
    addSceneSchemas(radioSchemas());
    addRadios();
#endif
#ifdef ISPACE_HAS_WEBOTS
    addImporters(webotsImporters());
#endif
    for (const auto& [extension, owner, name] : missingOffers()) {
        if (owner == "record") addMissingKeyword(name, extension);
        if (owner == "format") addMissingFormat(name, extension);
    }
    return true;
}

}  // namespace

std::span<const std::string_view> builtExtensions() {
    static const std::vector<std::string_view> names = {
#include "built_extensions.inc"
    };
    return names;
}

std::span<const ToolExtension> toolExtensions() {
    [[maybe_unused]] static const bool formats = addFormats();
    static const std::vector<ToolExtension> extensions = [] {
        std::vector<ToolExtension> rows = {
#ifdef ISPACE_HAS_CALIBRATION
            {"calibration", "envc", makeCalibration},
#endif
#ifdef ISPACE_HAS_JUDGE
            {"judge", "coverage", makeTrackJudge},
#endif
#ifdef ISPACE_HAS_LEARNING
            {"learning", "simrun", makeLearning},
#endif
#ifdef ISPACE_HAS_NAVIGATION
            {"navigation", "coverage", makeNavigationJudge},
#endif
#ifdef ISPACE_HAS_PRESSURE
            {"pressure", "scan", makePressureOptions},
#endif
#ifdef ISPACE_HAS_PROJECTION
            {"projection", "coverage", makeProjectionOptions},
#endif
#ifdef ISPACE_HAS_REALITY
            {"reality", "scan", makeRealityOptions},
#endif
        };
        for (const auto& [extension, owner, name] : missingOffers())
            if (owner != "record" && owner != "format")
                rows.push_back({extension, owner, nullptr, name});
        return rows;
    }();
    return extensions;
}

std::span<const ObjectiveRow> arrangeObjectives() {
    static const std::vector<ObjectiveRow> objectives = [] {
        std::vector<ObjectiveRow> rows = {
#ifdef ISPACE_HAS_EVENNESS
            {"evenness", makeEvenObjective},
#endif
#ifdef ISPACE_HAS_TRACKING
            {"tracking", makeTrackObjective},
#endif
        };
        for (const auto& [extension, owner, name] : missingOffers())
            if (owner == "objective") rows.push_back({extension, nullptr, name});
        return rows;
    }();
    return objectives;
}

std::span<const MakeJudge> runJudges() {
    static const std::vector<MakeJudge> judges = {
#ifdef ISPACE_HAS_EXPECT
        makeExpectations,
#endif
    };
    return judges;
}

std::span<const BridgeRow> runBridges() {
    static const std::vector<BridgeRow> bridges = {
#ifdef ISPACE_HAS_WIRE
        {"wire", makeWireOptions},
#endif
#ifdef ISPACE_HAS_WEB
        {"web", makeWebOptions},
#endif
#ifdef ISPACE_HAS_ROS
        {"ros", makeRosOptions},
#endif
#ifdef ISPACE_HAS_MQTT
        {"mqtt", makeMqttOptions},
#endif
    };
    return bridges;
}

std::span<const MakeRoleService> roleServices() {
    static const std::vector<MakeRoleService> services = {
#ifdef ISPACE_HAS_APPLIANCES
        makeMeters,
#endif
#ifdef ISPACE_HAS_BUMPERS
        makeBumpers,
#endif
#ifdef ISPACE_HAS_HEADS
        makeHeads,
#endif
#ifdef ISPACE_HAS_LOCKS
        makeLocks,
#endif
#ifdef ISPACE_HAS_MEMORY
        makeMemory,
#endif
#ifdef ISPACE_HAS_NODES
        makeNodes,
#endif
#ifdef ISPACE_HAS_PRESSURE
        makePressure,
#endif
#ifdef ISPACE_HAS_RADIOS
        makeRadios,
#endif
    };
    return services;
}

}  // namespace ispace
