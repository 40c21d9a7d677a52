// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh/mesh_cut.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/slice.h"
#include "env/walls.h"
#include "geom/arrangement.h"
#include "geom/point.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/mesh/mesh_file.h"
#include "io/plan/line_plan.h"

namespace ispace {

namespace {

constexpr double kStraight = 0.001;  // metres: floats of a file wobble by less

// Edges cross their neighbours, and some of other solids; uniting more of them takes work.
constexpr std::size_t kFreeCrossings = 8, kUnitsPerCrossing = 16;

/// Unites solids that meet at edges, such as walls that run into each other. Keeps a solid inside
/// another, e.g. furniture in a room modelled by its inner surface.
class Joiner {
  public:
    Joiner(std::vector<Polygon> solids, Budget& work) : solids_(std::move(solids)), work_(work) {
        for (std::size_t i = 0; i < solids_.size(); ++i) group_.push_back(i);
    }

    std::vector<Polygon> join() {
        groupTouching();
        std::map<std::size_t, std::vector<Polygon>> groups;
        for (std::size_t i = 0; i < solids_.size(); ++i)
            groups[rootOf(i)].push_back(std::move(solids_[i]));
        std::vector<Polygon> outlines;
        // Even single ones: a cavity joined to its outline by a seam becomes a separate curve.
        for (const auto& [root, group] : groups)
            for (Region& region : unite(group)) {
                outlines.push_back(std::move(region.outline));
                for (Polygon& hole : region.holes) outlines.push_back(std::move(hole));
            }
        return outlines;
    }

  private:
    std::size_t rootOf(std::size_t i) {
        while (group_[i] != i) i = group_[i] = group_[group_[i]];
        return i;
    }

    void groupTouching() {
        std::vector<Segment2> edges;
        std::vector<std::size_t> solid_of;
        for (std::size_t i = 0; i < solids_.size(); ++i)
            forEachEdge(solids_[i], [&](const Segment2& edge) {
                edges.push_back(edge);
                solid_of.push_back(i);
            });
        const NearSegments search(edges, work_);
        std::size_t crossings = 0;
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (const std::size_t k : search.near(bounds(edges[i]), 0)) {
                if (k >= i) break;
                if (!intersects(edges[i], edges[k])) continue;
                if (++crossings > kFreeCrossings * edges.size() && !work_.take(kUnitsPerCrossing))
                    throw FormatError(Diagnostic{
                        "", 0, 0, "crossings of the cut's outlines make " + work_.excess()});
                const std::size_t a = rootOf(solid_of[i]), b = rootOf(solid_of[k]);
                group_[std::max(a, b)] = std::min(a, b);
            }
    }

    std::vector<Polygon> solids_;
    std::vector<std::size_t> group_;
    Budget& work_;
};

}  // namespace

std::vector<PlanPath> cutPaths(Slice slice, Budget& work) {
    std::vector<PlanPath> paths;
    // Ends of triangles are not corners: the plan's opening finder would use them.
    for (Polygon& outline : simplified(Joiner(std::move(slice.solids), work).join(), kStraight))
        paths.push_back({std::move(outline), true, 0});
    for (const Segment2& sheet : slice.sheets) paths.push_back({{sheet.a, sheet.b}, false, 0});
    return paths;
}

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

}  // namespace ispace
