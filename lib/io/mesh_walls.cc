// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/importers.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/slice.h"
#include "geom/point.h"
#include "geom/polygon.h"
#include "io/import_records.h"
#include "io/line_plan.h"
#include "io/mesh_cut.h"
#include "io/mesh_file.h"

namespace ispace {

namespace {

constexpr double kDefaultCut = 1.2;  // metres: over most sills, under most lintels
constexpr double kStraight = 0.001;  // floats of a file wobble by less

/// The cut through a layer as lines of the plan.
void addShapes(Slice slice, const std::string& layer, std::vector<PlanShape>& shapes) {
    for (PlanPath& path : cutPaths(std::move(slice))) {
        PlanShape& shape = shapes.emplace_back();
        shape.path = std::move(path);
        shape.layer = layer;
    }
}

ImportOptions straightened(ImportOptions options) {
    options.simplify = options.simplify.value_or(kStraight);
    return options;
}

/// Lowest and highest point of meshes.
struct Heights {
    double low = HUGE_VAL, high = -HUGE_VAL;

    void add(const Body& body) {
        for (const Mesh& mesh : body.meshes)
            for (const Point3& p : mesh.vertices) {
                low = std::min(low, p.z);
                high = std::max(high, p.z);
            }
    }
    [[nodiscard]] std::string text() const {
        return "from " + formatFixed(low, 2) + " m to " + formatFixed(high, 2) + " m";
    }
};

}  // namespace

Document readMeshWalls(const std::string& operand, const ImportOptions& options,
                       const Schemas& schemas) {
    if (options.slice_top) failFile(operand, "a mesh is cut at one height: --slice-walls M");
    // The mesh as it would stand in a room.
    Document mesh = meshDocument(operand, options, schemas);
    loadMeshes(mesh, operand);
    const Body body = bodyOf(mesh.records.front());
    Slice slice{options.slice_walls.value_or(kDefaultCut), {}, {}};
    cutMeshes(body, slice.height, slice);
    std::vector<PlanShape> shapes;
    const double height = slice.height;
    addShapes(std::move(slice), "cut", shapes);
    if (shapes.empty()) {
        Heights heights;
        heights.add(body);
        failFile(operand, "nothing stands at " + formatFixed(height, 2) + " m: the mesh reaches " +
                              heights.text() + "; are --slice-walls, --units and --up right?");
    }
    ImportOptions plan = straightened(options);
    plan.wall_layers.clear();  // a mesh has none
    plan.door_layers.clear();
    plan.window_layers.clear();
    ImportRecords out(schemas, operand, options);
    for (std::string& side_file : mesh.sources) out.source(std::move(side_file));
    if (writeLinePlan(std::move(shapes), operand, plan, out) == 0)
        out.warn("the cut at " + formatFixed(height, 2) +
                 " m encloses no room, and what is inside of its walls may count as one: try "
                 "another height with --slice-walls, wider gaps with --close-gaps, or --up");
    return out.take();
}

}  // namespace ispace
