// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/importers.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/slice.h"
#include "env/walls.h"
#include "geom/boolean.h"
#include "geom/point.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "io/import_records.h"
#include "io/line_plan.h"
#include "io/mesh_file.h"
#include "io/plan_lines.h"

namespace ispace {

namespace {

constexpr double kAboveStorey = 1.2;    // metres: over most sills, under most lintels
constexpr double kStraight = 0.001;     // floats of a file wobble by less
constexpr double kNarrowOpening = 0.1;  // narrower ones are frames without a pane

bool edgesMeet(const Polygon& a, const Polygon& b) {
    bool meet = false;
    forEachEdge(a, [&](const Segment2& s) {
        forEachEdge(b, [&](const Segment2& t) { meet = meet || intersects(s, t); });
    });
    return meet;
}

/// Unites solids whose edges meet, as walls that run into each other. One inside another stays, as
/// furniture in a room modelled by its inner surface.
class Joiner {
  public:
    explicit Joiner(std::vector<Polygon> solids) : solids_(std::move(solids)) {
        for (std::size_t i = 0; i < solids_.size(); ++i) group_.push_back(i);
    }

    std::vector<Polygon> join() {
        groupTouching();
        std::map<std::size_t, std::vector<Polygon>> groups;
        for (std::size_t i = 0; i < solids_.size(); ++i)
            groups[rootOf(i)].push_back(std::move(solids_[i]));
        std::vector<Polygon> outlines;
        // Even single ones: a cavity joined to its outline by a seam becomes a curve of its own.
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

    /// From left to right, so that only boxes that overlap in x are compared.
    void groupTouching() {
        std::vector<Box2> boxes;
        for (const Polygon& solid : solids_) boxes.push_back(bounds(solid));
        std::vector<std::size_t> order(group_);
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(boxes[a].low.x, a) < std::pair(boxes[b].low.x, b);
        });
        for (std::size_t i = 0; i < order.size(); ++i)
            for (std::size_t k = i + 1; k < order.size(); ++k) {
                const Box2 &a = boxes[order[i]], &b = boxes[order[k]];
                if (b.low.x > a.high.x) break;
                if (b.low.y > a.high.y || b.high.y < a.low.y) continue;
                if (rootOf(order[i]) != rootOf(order[k]) &&
                    edgesMeet(solids_[order[i]], solids_[order[k]]))
                    group_[std::max(rootOf(order[i]), rootOf(order[k]))] =
                        std::min(rootOf(order[i]), rootOf(order[k]));
            }
    }

    std::vector<Polygon> solids_;
    std::vector<std::size_t> group_;
};

/// Where openings are cut out, faces of assimp's solids no longer share edges: lines that meet
/// within float rounding are joined again, and closed ones are solids.
void closeLoops(Slice& slice) {
    std::vector<PlanPath> lines;
    for (const Segment2& sheet : slice.sheets) lines.push_back({{sheet.a, sheet.b}, false, 0});
    slice.sheets.clear();
    for (PlanPath& path : joinedAtEnds(withoutRepeats(snapped(lines, kStraight)))) {
        if (path.closed && !selfCrossing(path.points)) {
            slice.solids.push_back(std::move(path.points));
            continue;
        }
        for (std::size_t i = 0; i < path.pieceCount(); ++i) slice.sheets.push_back(path.piece(i));
    }
}

/// The cut through a layer as lines of the plan.
void addShapes(Slice slice, const std::string& layer, std::vector<PlanShape>& shapes) {
    // Ends of triangles are not corners: openings would be fitted to them.
    for (Polygon& outline : simplified(Joiner(std::move(slice.solids)).join(), kStraight)) {
        PlanShape& shape = shapes.emplace_back();
        shape.path = {std::move(outline), true, 0};
        shape.layer = layer;
    }
    for (const Segment2& sheet : slice.sheets) {
        PlanShape& shape = shapes.emplace_back();
        shape.path = {{sheet.a, sheet.b}, false, 0};
        shape.layer = layer;
    }
}

/// The span of a door or window: its cut from side to side, along the longest edge.
std::optional<PlanShape> spanOf(const Slice& slice, const std::string& layer) {
    std::vector<Segment2> lines;
    slice.forEachLine([&](const Segment2& line) { lines.push_back(line); });
    const auto longest = std::max_element(lines.begin(), lines.end(), [](auto& a, auto& b) {
        return distance(a.a, a.b) < distance(b.a, b.b);
    });
    if (longest == lines.end() || longest->a == longest->b) return std::nullopt;
    const Vec2 along = (1 / distance(longest->a, longest->b)) * (longest->b - longest->a);
    const Vec2 across = perpendicular(along);
    Box2 box;  // in the frame of the edge
    for (const Segment2& line : lines)
        for (const Point2 p : {line.a, line.b})
            box.add({dot(p - longest->a, along), dot(p - longest->a, across)});
    if (box.width() < kNarrowOpening) return std::nullopt;
    const double aside = (box.low.y + box.high.y) / 2;
    const Segment2 line{longest->a + box.low.x * along + aside * across,
                        longest->a + box.high.x * along + aside * across};
    PlanShape shape;
    shape.path.points = {line.a, line.b};
    shape.chords.push_back({line, {}});
    shape.layer = layer;
    return shape;
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

Mesh meshOf(const TriangleMesh& triangles) {
    Mesh mesh;
    mesh.vertices.reserve(triangles.vertices.size());
    for (const auto& [x, y, z] : triangles.vertices) mesh.vertices.push_back({x, y, z});
    mesh.triangles = triangles.triangles;
    return mesh;
}

/// All parts below the node of one product: a wall, a door, a chair.
struct Product {
    std::string kind;  ///< its class in IFC
    Body body;
    std::optional<double> storey;  ///< height of the one it belongs to
};

class IfcReader {
  public:
    IfcReader(const std::string& operand, const ImportOptions& options)
        : operand_(operand), options_(straightened(options)) {
        if (options_.wall_layers.empty())
            options_.wall_layers = {"IfcWall*",  "IfcCurtainWall*", "IfcColumn*",
                                    "IfcPlate*", "IfcMember*",      "IfcBuildingElementProxy*"};
        if (options_.door_layers.empty()) options_.door_layers = {"IfcDoor*"};
        if (options_.window_layers.empty()) options_.window_layers = {"IfcWindow*"};
        gather(loadMeshParts(operand, {options.up}));
    }

    void write(ImportRecords& out) {
        const double height = options_.slice_walls.value_or(lowestStorey(out) + kAboveStorey);
        out.note("cut at a height of " + formatFixed(height, 2) + " m");
        std::map<std::string, Slice> cuts;  // of all but openings, by kind
        std::vector<PlanShape> shapes;
        for (const auto& [name, product] : products_) {
            Slice slice{height, {}, {}};
            cutMeshes(product.body, height, slice);
            if (product.kind.starts_with("IfcDoor") || product.kind.starts_with("IfcWindow")) {
                if (auto span = spanOf(slice, product.kind)) shapes.push_back(std::move(*span));
                continue;
            }
            closeLoops(slice);
            Slice& all = cuts[product.kind];
            all.solids.insert(all.solids.end(), slice.solids.begin(), slice.solids.end());
            all.sheets.insert(all.sheets.end(), slice.sheets.begin(), slice.sheets.end());
        }
        for (auto& [kind, slice] : cuts) addShapes(std::move(slice), kind, shapes);
        if (shapes.empty()) failFile(operand_, nothingAt(height));
        writeLinePlan(std::move(shapes), operand_, options_, out);
    }

  private:
    /// "IfcWallStandardCase_name_id" is the node of a product, others are parts of it.
    static std::string kindOf(const std::string& node) {
        if (!node.starts_with("Ifc") || node.starts_with("IfcMappedItem")) return "";
        return printable(std::string_view(node).substr(0, node.find('_')));
    }

    void gather(std::vector<MeshPart> parts) {
        for (MeshPart& part : parts) {
            const auto node =
                std::find_if(part.nodes.begin(), part.nodes.end(),
                             [](const MeshNode& n) { return !kindOf(n.name).empty(); });
            if (node == part.nodes.end()) continue;
            // Names are unique by the id they end with.
            Product& product = products_[node->name];
            product.kind = kindOf(node->name);
            for (auto outer = node; outer != part.nodes.end(); ++outer)
                if (outer->name.starts_with("IfcBuildingStorey")) product.storey = outer->height;
            product.body.meshes.push_back(meshOf(part.mesh));
        }
    }

    /// The lowest storey with walls, else the foot of the building.
    double lowestStorey(ImportRecords& out) const {
        std::optional<double> lowest;
        for (const auto& [name, product] : products_)
            if (product.storey && product.kind.starts_with("IfcWall"))
                lowest = std::min(lowest.value_or(*product.storey), *product.storey);
        if (lowest) return *lowest;
        out.note("no storey has walls: its foot is taken");
        return heights().low;
    }

    [[nodiscard]] Heights heights() const {
        Heights heights;
        for (const auto& [name, product] : products_) heights.add(product.body);
        return heights;
    }

    [[nodiscard]] std::string nothingAt(double height) const {
        if (products_.empty()) return "no wall and no other product of IFC in the building";
        return "nothing stands at " + formatFixed(height, 2) + " m: the building reaches " +
               heights().text() + "; say another height with --slice-walls";
    }

    const std::string& operand_;
    ImportOptions options_;
    std::map<std::string, Product> products_;
};

}  // namespace

Document readMeshWalls(const std::string& operand, const ImportOptions& options,
                       const Schemas& schemas) {
    // The mesh as it would stand in a room.
    Document mesh = meshDocument(operand, options, schemas);
    loadMeshes(mesh, operand);
    const Body body = bodyOf(mesh.records.front());
    Slice slice{options.slice_walls.value_or(kAboveStorey), {}, {}};
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
    writeLinePlan(std::move(shapes), operand, plan, out);
    return out.take();
}

bool isIfc(std::string_view bytes) {
    bytes = bytes.substr(0, 1 << 16);
    const std::size_t schema = bytes.find("FILE_SCHEMA");
    return bytes.starts_with("ISO-10303-21") && schema != std::string_view::npos &&
           bytes.substr(schema, bytes.find(';', schema) - schema).find("IFC") !=
               std::string_view::npos;
}

Document readIfc(std::string_view bytes, const std::string& operand, const ImportOptions& options,
                 const Schemas& schemas) {
    if (operand == "-")
        failFile(operand,
                 "a building on standard input: name its file instead, it is read by assimp");
    if (bytes.find("END-ISO-10303-21") == std::string_view::npos)
        failFile(operand, "truncated: the building ends without `END-ISO-10303-21;`");
    ImportRecords out(schemas, operand, options);
    IfcReader(operand, options).write(out);
    return out.take();
}

}  // namespace ispace
