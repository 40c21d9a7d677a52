// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: the parts of checkScene.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "env/info.h"
#include "env/point_location.h"
#include "env/walls.h"
#include "layout/overlap.h"
#include "layout/scene.h"

namespace ispace {

/// What all checks look at.
struct CheckContext {
    explicit CheckContext(const Scene& from);

    [[nodiscard]] const Element& element(std::size_t i) const {
        return scene.environment.elements()[i];
    }
    /// Outside the room, and farther from its walls than touching.
    [[nodiscard]] bool isOut(Point2 p) const { return !indoor.isWithin(p, kTouching); }
    /// Furniture, pillars, ceiling frames, meshes.
    [[nodiscard]] bool isObject(std::size_t i) const;
    /// "desk d1", or the id alone where that is keyword and number.
    [[nodiscard]] std::string name(std::size_t i) const;
    [[nodiscard]] std::string placedName(std::size_t placed) const;
    /// A finding at an element, its name before the message.
    [[nodiscard]] Diagnostic finding(std::size_t i, const std::string& message) const;

    const Scene& scene;
    const RegionIndex& indoor;
    Parts parts;
    std::map<std::size_t, MeshCuts> meshes;  ///< by element
};

/// "0.12 m", rounded up.
std::string wayText(double way);

/// Objects and zones: what they share with others, and whether they are in the room.
class ThingCheck {
  public:
    explicit ThingCheck(CheckContext& context) : context_(&context) {}
    void check(std::size_t element, Diagnostics& findings);

  private:
    struct Shared {
        Point2 place;
        double way = 0;  ///< 0: not known
    };

    void checkObject(std::size_t element, Diagnostics& findings);
    void checkZone(std::size_t element, Diagnostics& findings) const;
    void checkInRoom(std::size_t element, bool in_wall, Diagnostics& findings) const;
    [[nodiscard]] bool isPartOfBuilding(std::size_t element) const;
    /// The elements after this one, and walls, that may share space with it; ascending.
    [[nodiscard]] std::vector<std::size_t> neighbours(std::size_t element) const;
    std::optional<Shared> shared(std::size_t a, std::size_t b);
    [[nodiscard]] std::optional<Shared> sharedParts(std::size_t a, std::size_t b) const;
    std::optional<Point2> sharedMesh(MeshCuts& mesh, std::size_t other);
    static std::optional<Point2> sharedMeshes(MeshCuts& a, MeshCuts& b);

    CheckContext* context_;
};

/// What is placed: sensors at a point, robots and people as circles.
class PlacedCheck {
  public:
    explicit PlacedCheck(CheckContext& context);
    void check(std::size_t placed, Diagnostics& findings);

  private:
    struct Circle {
        std::size_t placed;
        Point2 center;
        double radius, height;
    };
    struct Met {
        Point2 place;
        double way;
    };

    void checkPoint(std::size_t placed, Diagnostics& findings);
    void checkCircle(const Circle& circle, Diagnostics& findings);
    /// What the meshes of an element fill below a height.
    struct MeshBand {
        Slice band;
        BoxTree solids, sheets;
    };

    const MeshBand& bandOf(std::size_t element, double height);
    [[nodiscard]] std::map<std::size_t, Met> metBy(const Circle& circle);
    [[nodiscard]] Diagnostic finding(std::size_t placed, const std::string& message) const;

    CheckContext* context_;
    std::vector<Circle> circles_;  // in order
    BoxTree tree_;                 // of the circles
    std::map<std::pair<std::size_t, double>, MeshBand> bands_;
};

}  // namespace ispace
