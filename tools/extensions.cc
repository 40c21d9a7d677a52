// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of extensions, in the order of `--help`, and in which they measure (advice, which a
// signal may end, is the last): folders of lib/extensions. Those that CMake
// does not build (ISPACE_EXTENSIONS) are empty lines of it.
#include "extensions.h"

#include <vector>

#include "built_extensions.inc"

namespace ispace {

const Extensions& extensions() {
    static const std::vector<Extension> built = {
        // clang-format off
        ISPACE_APPLIANCES
        ISPACE_BUMPERS
        ISPACE_CAD
        ISPACE_CALIBRATION
        ISPACE_CURTAINS
        // Kinds of sensors, in the order in which reports list them.
        ISPACE_RADARS
        ISPACE_PIRS
        ISPACE_CONTACTS
        ISPACE_RFIDS
        ISPACE_UWBS
        ISPACE_MICROPHONES
        ISPACE_LUXES
        ISPACE_IMUS
        ISPACE_MOTES
        ISPACE_THERMOMETERS
        ISPACE_DOORCOUNTERS
        ISPACE_RUNS
        ISPACE_DAYS
        ISPACE_GOALS
        ISPACE_EVENNESS
        ISPACE_EXPECT
        ISPACE_FILMS
        ISPACE_GAZEBO
        ISPACE_HEADS
        ISPACE_IFC
        ISPACE_JUDGE
        ISPACE_LEARNING
        ISPACE_LEDS
        ISPACE_LOCKS
        ISPACE_MAPS
        ISPACE_MEMORY
        ISPACE_MESHES
        ISPACE_NAV2
        ISPACE_NAVIGATION
        ISPACE_NODES
        ISPACE_PAGES
        ISPACE_PASSAGES
        ISPACE_POSTURES
        ISPACE_PRESENCE
        ISPACE_PRESSURE
        ISPACE_PROJECTION
        ISPACE_PROOFS
        ISPACE_RADIOS
        ISPACE_REALITY
        ISPACE_ROBUSTNESS
        ISPACE_TRACKING
        ISPACE_VIEWS
        ISPACE_CAMERARULES
        ISPACE_ADVICE
        ISPACE_WIRE
        ISPACE_WEB
        ISPACE_ROS
        ISPACE_MQTT
        ISPACE_WEBOTS
        ISPACE_WORLDS
        // clang-format on
    };
    static const std::vector<MissingOffer> missing = {
#include "missing_offers.inc"
    };
    static const Extensions all(built, missing);
    return all;
}

}  // namespace ispace
