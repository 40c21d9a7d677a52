// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/scene/findings: the checks of a scene, one list for all tools, so that all report the
// same. Below the list stand the parts of single checks, for the sources of this folder.
//
// Overlaps, and positions outside the room, count beyond kCornerTolerance. Findings depend on the
// scene alone; each call derives its own data, so several threads may check scenes at once.
//
//     for (const Finding& finding : checkScene(scene, {.checks = {"outside", "buried"}}))
//         texts.push_back(finding.diagnostic().text());
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "env/environment.h"
#include "env/point_location.h"
#include "env/walls.h"
#include "scene/overlap.h"
#include "scene/scene.h"

namespace ispace {

/// A mistake in a scene that can be compiled all the same. Elements of the room that other uses
/// accept are warnings; records that cannot work at their position are errors.
struct Finding {
    Severity severity = Severity::Warning;
    std::string element = {};    ///< its id; "" for the scene as a whole
    Point2 at = {};              ///< in the world frame; undefined if `message` names no position
    std::string message = {};    ///< "laser l stands outside the room at (9.0, 3.0)"
    std::string hint = {};       ///< "move it in"
    SourcePosition source = {};  ///< of the element's record

    /// Returns message and hint in one sentence.
    [[nodiscard]] std::string text() const { return message + "; " + hint; }
    /// Returns the sentence with its file, line and column.
    [[nodiscard]] Diagnostic diagnostic() const;
};

struct CheckContext;

/// A row of the list.
struct SceneCheck {
    std::string_view name;
    /// Adds the findings about the record with this index in Scene::records; the index past the
    /// last record stands for the scene as a whole.
    void (*run)(CheckContext&, std::size_t record, std::vector<Finding>&);
};

/// All checks, in the order in which they look at a record:
///
/// - walls: walls that cross or lie on each other; open doors that lead into a wall close behind.
/// - objects: furniture, pillars, ceiling frames and meshes that share space with each other or
///   with a wall, in 3-D, by more than 1 um, or lie outside the room. Pillars, ceiling frames and
///   walls may share space. Meshes are compared at some heights that both sides share.
/// - zones: zones without a point in the room.
/// - unplaced: sensors without a position.
/// - outside: sensors, tags, mats, gates, robots and people outside the room or below its floor;
///   not the sensors of a robot, as the robot is named.
/// - buried: sensors and tags inside solids.
/// - collisions: robots and people (as circles) that stand in objects or in each other.
/// - paths: points of paths of robots and people outside the room; sim/course_check.h walks the
///   legs.
/// - loose ends: ends of walls in the room less than 0.2 m before another wall.
/// - records: mistakes in records of extensions, see addRecordCheck().
std::span<const SceneCheck> sceneChecks();

/// Checks the record of a scene with this index. Returns empty if it is right.
using RecordCheck = std::optional<Finding> (*)(const Scene& scene, std::size_t record);

/// Makes a check of the records of a scene that shares derived data among them.
using RecordCheckMaker =
    std::function<std::optional<Finding>(std::size_t record)> (*)(const Scene& scene);

/// Adds a check of the records with a keyword to those that it has, for the program: call it before
/// any scene is checked.
void addRecordCheck(std::string_view keyword, RecordCheck check);
void addRecordCheck(std::string_view keyword, RecordCheckMaker make);

/// Selects findings; by default all.
struct FindingFilter {
    /// Names of the checks to run; empty: all.
    std::vector<std::string_view> checks = {};
    /// Returns true for the ids of the records to check; unset: all.
    std::function<bool(const std::string& id)> ids = {};
};

/// Checks the scene and returns the findings in the order of the records, one for each pair of
/// elements. Stops after the record that brings them to Diagnostics::kMax. O(n log n) for n
/// elements side by side.
std::vector<Finding> checkScene(const Scene& scene, const FindingFilter& filter = {});

/// Returns the findings that a tool reports as warnings before it runs, at most Diagnostics::kMax.
std::vector<Diagnostic> sceneWarnings(const Scene& scene, const FindingFilter& filter);

struct CheckContext;

/// Checks objects and zones for overlaps with other elements and for positions outside the room.
class ThingCheck {
  public:
    explicit ThingCheck(CheckContext& context) : context_(&context) {}
    void checkObject(std::size_t element, std::vector<Finding>& findings);
    void checkZone(std::size_t element, std::vector<Finding>& findings) const;

  private:
    struct Shared {
        Point2 place;
        double way = 0;  ///< 0: not known
    };

    void checkInRoom(std::size_t element, bool in_wall, std::vector<Finding>& findings) const;
    [[nodiscard]] bool isPartOfBuilding(std::size_t element) const;
    /// Returns the elements after this one, and walls, that may overlap it; ascending.
    [[nodiscard]] std::vector<std::size_t> neighbours(std::size_t element) const;
    std::optional<Shared> shared(std::size_t a, std::size_t b);
    [[nodiscard]] std::optional<Shared> sharedParts(std::size_t a, std::size_t b) const;
    std::optional<Point2> sharedMesh(MeshCuts& mesh, std::size_t other);
    static std::optional<Point2> sharedMeshes(MeshCuts& a, MeshCuts& b);

    CheckContext* context_;
};

/// Finds robots and people, as circles, that stand in objects or in each other.
class CircleCheck {
  public:
    explicit CircleCheck(CheckContext& context);
    void check(std::size_t record, std::vector<Finding>& findings);

  private:
    struct Circle {
        std::size_t record;
        Point2 center;
        double radius, height;
    };
    struct Met {
        Point2 place;
        double way;
    };
    /// The solids of an element's meshes below a height.
    struct MeshBand {
        Slice band;
        BoxTree solids, sheets;
    };

    const MeshBand& bandOf(std::size_t element, double height);
    [[nodiscard]] std::map<std::size_t, Met> metBy(const Circle& circle);

    CheckContext* context_;
    std::vector<Circle> circles_;  // in order
    BoxTree tree_;                 // of the circles
    std::map<std::pair<std::size_t, double>, MeshBand> bands_;
};

/// The scene under check and derived data that several checks share, computed on demand.
struct CheckContext {
    explicit CheckContext(const Scene& from);

    [[nodiscard]] const Element& element(std::size_t i) const {
        return scene.environment.elements()[i];
    }
    /// Returns true if p is outside the room by more than kCornerTolerance.
    [[nodiscard]] bool isOut(Point2 p) const { return !indoor.isWithin(p, kCornerTolerance); }
    /// Returns true for furniture, pillars, ceiling frames and meshes.
    [[nodiscard]] bool isObject(std::size_t element) const;
    /// Returns "desk d1", or the id alone if it consists of keyword and number.
    [[nodiscard]] std::string name(std::size_t record) const;
    [[nodiscard]] std::string elementName(std::size_t element) const;
    /// Creates a finding about a record; its name precedes the message.
    [[nodiscard]] Finding finding(std::size_t record, Severity severity, Point2 at,
                                  const std::string& message, std::string hint) const;
    /// Creates a warning about an element.
    [[nodiscard]] Finding warning(std::size_t element, Point2 at, const std::string& message,
                                  std::string hint) const;

    const Parts& parts();
    /// Returns those above, below or around the origins of placed records.
    const Parts& partsAbout();
    std::map<std::size_t, MeshCuts>& meshes();  ///< by element
    /// Returns the findings about walls and doors, by element.
    const std::multimap<std::size_t, Finding>& walls();
    CircleCheck& circles();
    /// Returns the findings of a check about a record.
    std::optional<Finding> made(RecordCheckMaker make, std::size_t record);

    const Scene& scene;
    const RegionIndex& indoor;
    std::vector<std::size_t> records;                    ///< by element
    std::vector<std::optional<std::size_t>> element_of;  ///< by record
    std::vector<const PlacedRecord*> placed_of;          ///< by record, or null

  private:
    std::optional<Parts> parts_, parts_about_;
    std::optional<std::map<std::size_t, MeshCuts>> meshes_;
    std::optional<std::multimap<std::size_t, Finding>> walls_;
    std::optional<CircleCheck> circles_;
    std::map<RecordCheckMaker, std::function<std::optional<Finding>(std::size_t record)>> made_;
};

/// Writes a distance rounded up, "0.12 m".
std::string distanceText(double way);

/// Finds walls that cross and open doors that lead into a wall.
std::multimap<std::size_t, Finding> wallFindings(const CheckContext& context);

void checkLooseEnds(CheckContext& context, std::size_t record, std::vector<Finding>& findings);
void checkUnplaced(CheckContext& context, std::size_t record, std::vector<Finding>& findings);
void checkOutside(CheckContext& context, std::size_t record, std::vector<Finding>& findings);
void checkBuried(CheckContext& context, std::size_t record, std::vector<Finding>& findings);
void checkPath(CheckContext& context, std::size_t record, std::vector<Finding>& findings);

/// Returns true once a scene has as many findings as are reported.
inline bool isFull(const std::vector<Finding>& findings) {
    return findings.size() >= Diagnostics::kMax;
}

}  // namespace ispace
