// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh as a record, or cut into the walls of a room.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/slice.h"
#include "extensions/meshes/meshes.h"
#include "geom/point.h"
#include "io/import_records.h"
#include "io/mesh_files.h"
#include "io/plan/cut_paths.h"
#include "io/plan/line_plan.h"

namespace ispace::meshes {

namespace {

constexpr double kDefaultCut = 1.2;  // metres: over most sills, under most lintels

/// Returns the cut through a layer as lines of the plan.
void addShapes(Slice slice, const std::string& layer, Budget& work,
               std::vector<PlanShape>& shapes) {
    for (PlanPath& path : cutPaths(std::move(slice), work)) {
        PlanShape& shape = shapes.emplace_back();
        shape.path = std::move(path);
        shape.layer = layer;
    }
}

ImportOptions straightened(ImportOptions options) {
    options.simplify = options.simplify.value_or(kMeshStraight);
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

Document meshDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas) {
    if (operand == "-")
        throw FormatError(
            Diagnostic{displayName(operand), 0, 0,
                       std::string("a mesh on standard input: name its file instead") +
                           (options.slice_walls ? ", as meshes are read from files alone"
                                                : ", so that records can refer to it")});
    ImportRecords out(schemas, operand, options);
    Record& record = out.add("mesh", 0);
    const std::filesystem::path path(operand);
    record.set("id", out.freeId(path.stem().string(), "mesh"));
    record.set("file", path.filename().string());
    if (!options.units.empty()) record.set("unit", options.units);
    record.set("up", options.own.get<UpAxis>().name);
    return out.take();
}

Document readMeshWalls(const std::string& operand, const ImportOptions& options,
                       const Schemas& schemas) {
    if (options.slice_top) failFile(operand, "a mesh is cut at one height: --slice-walls M");
    // The mesh in its default pose in a room.
    Document mesh = meshDocument(operand, options, schemas);
    loadMeshes(mesh, operand, options);
    const Body body = bodyOf(mesh.records.front());
    const double height = options.slice_walls.value_or(kDefaultCut);
    Slice slice;
    cutMeshes(body, height, slice);
    std::vector<PlanShape> shapes;
    std::size_t bytes = 0;  // as STL has them
    for (const Mesh& part : body.meshes) bytes += 50 * part.triangles.size();
    Budget work(bytes, options.max_work);
    withFileName(operand, [&] { addShapes(std::move(slice), "cut", work, shapes); });
    if (shapes.empty()) {
        Heights heights;
        heights.add(body);
        failFile(operand, "nothing stands at " + formatFixed(height, 2) + " m: the mesh reaches " +
                              heights.text() + "; are --slice-walls, --units and --up right?");
    }
    ImportOptions plan = straightened(options);
    plan.wall_layers.clear();  // a mesh has no layers
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

}  // namespace ispace::meshes
