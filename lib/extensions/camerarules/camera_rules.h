// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/camerarules: faces that cameras see from ahead, and zones that they must not see.
//
// Both are areas of overlays of the cameras' exact regions, in which a set of points that face a
// camera is a wedge: apex at the camera, sides at the rule's angle. What remains is cut to the box
// of its zone before it is united, since the lattice of an overlay grows with its extent.
//
//     const FacingRule rule = parseFacing("entrance,45deg,180=90%");
//     for (const FacingResult& result : measureFacing(scene, coverage, {&rule, 1}))
//         if (!isMet(result)) unmet.push_back(result.rule.zone);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coverage/coverage.h"
#include "env/environment.h"
#include "scene/scene.h"

namespace ispace::camerarules {

/// Floor on which people walk in one heading.
struct FacingPart {
    Polygon outline;
    Angle heading;
};

/// A face at a point of the zone counts as seen by a camera only if the level direction from the
/// point to the camera is within an angle of the heading in which people walk there.
struct FacingRule {
    std::string zone;  ///< its id, or the text of a zone of doors
    Angle within, heading;
    std::optional<double> required = {};  ///< share of the zone
    bool is_by_doors = false;             ///< `heading` follows from doors, see facingIn()
    // As facingIn() sets them.
    std::string door = {};               ///< id of the door that gave the headings
    std::vector<FacingPart> parts = {};  ///< of the zone
};

/// Cameras must not see these zones, or only with fewer pixels a metre.
struct PrivacyRule {
    std::string zones;   ///< a glob of ids
    double density = 0;  ///< pixels a metre that are too many; 0: any sight is
};

/// Parses `entrance,45deg,180` and `zone:entrance,45deg,180=90%`; without heading it is that of
/// doors. `door:GLOB[,M][,DEG[,HEADING]]` is the floor within M of doors, 1.5 m by default, and
/// within 45 degrees by default. \throws UsageError
FacingRule parseFacing(std::string_view text);
/// Tells of rules of facing that are judged on the floor.
constexpr std::string_view kFacesOnFloor =
    "--facing judges the floor, which cameras that look down see, too: --plane 1.6 judges it "
    "at the height of faces";
/// Largest distance of a door's opening from the zones that it leads into, metres.
constexpr double kAtDoor = 0.3;
/// Returns a rule with its parts for each zone that matches and, without a heading, for each door
/// on its border: people walk into the zone, straight through the door. A door is on the border of
/// a zone if it is within kAtDoor of it and indoor floor of the zone lies on one side of the door
/// alone. A zone of doors is one for each door that matches; at each side of the door that is
/// indoors people walk away from it, or all in the heading that is given. Rules that have parts
/// stay as they are.
/// \throws UsageError for an unknown zone, and for one without such a door
std::vector<FacingRule> facingIn(const Environment& environment, std::span<const FacingRule> rules);
/// Returns true if a camera at this point sees faces from ahead at a point where people walk in a
/// heading.
bool isFaced(Angle heading, Angle within, Point2 place, Point2 camera);
/// Returns the ids of the zones of a rule of privacy. \throws UsageError for a glob that matches
/// none
std::vector<std::string> privateZones(const PrivacyRule& rule, const Environment& environment);
/// Parses `zone:desk*`, `desk*,recognise` and `desk*,125`. \throws UsageError
PrivacyRule parsePrivacy(std::string_view text);

/// A rule of facing and the share of its zone that meets it.
struct FacingResult {
    FacingRule rule;
    double area = 0;                   ///< of the indoor part of the zone, m2
    std::optional<double> share = {};  ///< of that, seen from ahead; empty if a region is unknown
};

/// A zone of a rule of privacy and the floor of it that cameras see.
struct PrivacyResult {
    std::string zone;
    double density = 0;
    double area = 0;                        ///< of the indoor part of the zone, m2
    std::optional<double> seen = {};        ///< m2; empty if a region is unknown
    std::vector<std::string> cameras = {};  ///< that see some of it
};

/// Intersects the view of each camera, as `coverage` has it, with the wedge of points that face it,
/// and the union with the zone; exact. \throws UsageError for an unknown zone
std::vector<FacingResult> measureFacing(const Scene& scene, const Coverage& coverage,
                                        std::span<const FacingRule> rules);

/// Measures the part of each zone that cameras see with so many pixels a metre, in their whole
/// fields of view on a plane, whatever density is asked for elsewhere; exact. One result for each
/// zone of each rule. \throws UsageError for a glob that matches no zone
std::vector<PrivacyResult> measurePrivacy(const Scene& scene, double plane,
                                          std::span<const PrivacyRule> rules);

/// Measures the same of one rule by the views of cameras in `coverage`, which counts their pixels
/// at the density of the rule: also of cameras in other rooms.
std::vector<PrivacyResult> measurePrivacy(const Scene& scene, const Coverage& coverage,
                                          const PrivacyRule& rule);

/// Returns true if the required share is seen, within rounding; true without one.
bool isMet(const FacingResult& result);
/// Returns true unless more than kMinPiece is seen, or the area seen is unknown.
bool isMet(const PrivacyResult& result);

}  // namespace ispace::camerarules
