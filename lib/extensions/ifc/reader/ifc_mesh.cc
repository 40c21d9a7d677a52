// SPDX-License-Identifier: GPL-3.0-or-later
// Items of geometry as plane faces.
#include "extensions/ifc/reader/ifc_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "extensions/ifc/reader/ifc_shapes.h"
#include "io/packed_mesh.h"

namespace ispace::ifc {

namespace {

using Loop = std::span<const Point3>;

/// Computes twice the area of a loop, along its normal (Newell).
Vec3 areaVector(Loop loop) {
    Vec3 sum;
    for (std::size_t i = 2; i < loop.size(); ++i)
        sum = sum + cross(loop[i - 1] - loop[0], loop[i] - loop[0]);
    return sum;
}

/// Appends triangles of doubles to floats, corner by corner.
class TriangleList {
  public:
    void add(Point3 a, Point3 b, Point3 c) {
        if (mesh_.triangles.size() >= kMaxMeshTriangles)
            throw std::runtime_error("more than " + std::to_string(kMaxMeshTriangles) +
                                     " triangles");
        mesh_.triangles.push_back({corner(a), corner(b), corner(c)});
    }

    /// A plane face: the largest loop without the others.
    void addFace(const std::vector<Loop>& loops) {
        std::vector<std::pair<double, std::size_t>> sizes;
        for (std::size_t i = 0; i < loops.size(); ++i)
            sizes.emplace_back(-length(areaVector(loops[i])), i);
        if (sizes.empty()) return;
        std::sort(sizes.begin(), sizes.end());
        const Loop outer = loops[sizes.front().second];
        const Vec3 normal = unitOf(areaVector(outer));
        if (normal == Vec3{}) return;
        if (loops.size() == 1 && outer.size() == 3) return add(outer[0], outer[1], outer[2]);
        // Seen along the axis that the normal is nearest to, mirrored where it points away.
        const Vec3 size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
        const int axis = size.z >= std::max(size.x, size.y) ? 2 : size.y >= size.x ? 1 : 0;
        const double sign = (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) > 0 ? 1 : -1;
        const auto flat = [&](const Point3& p) {
            if (axis == 2) return Point2{p.x, sign * p.y};
            return axis == 1 ? Point2{p.z, sign * p.x} : Point2{p.y, sign * p.z};
        };
        std::map<std::pair<double, double>, Point3> back;
        Region face;
        for (const auto& [area, i] : sizes) {
            Polygon polygon;
            for (const Point3& p : loops[i]) {
                polygon.push_back(flat(p));
                back.try_emplace({polygon.back().x, polygon.back().y}, p);
            }
            const bool is_outer = i == sizes.front().second;
            if ((signedArea(polygon) > 0) != is_outer) std::reverse(polygon.begin(), polygon.end());
            if (is_outer)
                face.outline = std::move(polygon);
            else
                face.holes.push_back(std::move(polygon));
        }
        const Triangulation flat_triangles = triangulate(face);
        for (const auto& t : flat_triangles.triangles) {
            std::array<Point3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                const Point2 p = flat_triangles.vertices[t[k]];
                const auto found = back.find({p.x, p.y});
                if (found == back.end()) return;
                corners[k] = found->second;
            }
            add(corners[0], corners[1], corners[2]);
        }
    }

    [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

  private:
    std::uint32_t corner(Point3 p) {
        const std::array<float, 3> place{static_cast<float>(p.x + 0), static_cast<float>(p.y + 0),
                                         static_cast<float>(p.z + 0)};
        if (!std::isfinite(place[0]) || !std::isfinite(place[1]) || !std::isfinite(place[2]))
            throw std::runtime_error("a vertex that is no place (NaN or infinity)");
        const auto [known, is_new] =
            index_.try_emplace(place, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new) mesh_.vertices.push_back(place);
        return known->second;
    }

    std::map<std::array<float, 3>, std::uint32_t> index_;
    TriangleMesh mesh_;
};

bool isBody(std::string_view type) {
    return type != "IFCSPACE" && !type.starts_with("IFCOPENING") && type != "IFCANNOTATION" &&
           type != "IFCSPATIALZONE" && type != "IFCGRID";
}

}  // namespace

TriangleMesh ifcMesh(std::string_view bytes, Budget& work) {
    const StepFile file(bytes, &work);
    IfcFrames frames(file);
    IfcShapes shapes(frames, work);
    TriangleList triangles;
    const auto add_product = [&](StepId id) {
        const StepInstance product = file.read(id);
        if (file.typeOf(product[5].reference()) != "IFCLOCALPLACEMENT") return;
        IfcShape shape = shapes.shapeOf(product[6].reference());
        const IfcFrame frame = frames.placement(product[5].reference());
        for (IfcSolid& solid : shape) {
            solid.body.move(frame);
            std::size_t loop = 0, corner = 0;
            for (const std::uint32_t face_end : solid.body.face_ends) {
                std::vector<Loop> loops;
                for (; loop < face_end; corner = solid.body.loop_ends[loop++])
                    loops.push_back(Loop(solid.body.corners)
                                        .subspan(corner, solid.body.loop_ends[loop] - corner));
                triangles.addFace(loops);
            }
        }
    };
    for (const auto& [type, ids] : file.types()) {
        if (!isBody(type)) continue;
        for (const StepId id : ids) {
            try {
                add_product(id);
            } catch (const UnreadGeometry&) {
                // Count it like an unsupported part of a shape.
            }
        }
    }
    return triangles.take();
}

namespace {

constexpr double kFootprintHeight = 2.5;  // metres
/// Pays for the work: elements may share a shape without a map.
constexpr const char* kShared = "shared shapes";

/// Builds the surface that a profile sweeps through frames, which map its plane into space; closed
/// at both ends, or without ends if it returns to the first frame.
IfcFaces swept(IfcCurves& curves, const IfcArea& area, std::span<const IfcFrame> frames,
               bool comes_back) {
    std::size_t outline = 0;
    for (const Polygon& polygon : area) outline += polygon.size();
    // Four corners for each piece of the outline and step, and two ends.
    curves.pay(area.size() + outline * (4 * frames.size() - 2), kShared);
    IfcFaces faces;
    const auto loop_in = [](const Polygon& polygon, const IfcFrame& frame) {
        std::vector<Point3> loop;
        loop.reserve(polygon.size());
        for (const Point2 p : polygon) loop.push_back(frame.at({p.x, p.y, 0}));
        return loop;
    };
    const auto add_cap = [&](const IfcFrame& frame) {
        for (const Polygon& polygon : area) faces.addLoop(loop_in(polygon, frame));
        faces.endFace();
    };
    for (std::size_t k = 1; k < frames.size(); ++k)
        for (const Polygon& polygon : area) {
            const std::vector<Point3> low = loop_in(polygon, frames[k - 1]);
            const std::vector<Point3> high = loop_in(polygon, frames[k]);
            for (std::size_t i = 0, j = low.size() - 1; i < low.size(); j = i++) {
                faces.addLoop(std::array{low[j], low[i], high[i], high[j]});
                faces.endFace();
            }
        }
    if (!comes_back) {
        add_cap(frames.front());
        add_cap(frames.back());
    }
    return faces;
}

IfcArea checkedArea(IfcCurves& curves, StepId profile) {
    IfcArea area = *curves.profile(profile);
    std::erase_if(area, [](const Polygon& polygon) { return polygon.empty(); });
    if (area.empty()) throw UnreadGeometry("a profile without area");
    return area;
}

IfcFaces extruded(IfcCurves& curves, const IfcArea& area, const IfcFrame& position, Vec3 by) {
    IfcFrame end = position;
    end.origin = position.at({by.x, by.y, by.z});
    return swept(curves, area, std::array{position, end}, false);
}

IfcFaces extrusion(IfcCurves& curves, const StepInstance& solid) {
    const IfcFrames& frames = curves.frames();
    const Vec3 unit = unitOf(frames.direction(solid[2].reference(), {0, 0, 1}));
    return extruded(curves, checkedArea(curves, solid[0].reference()),
                    frames.axes(solid[1].reference()), frames.length(solid[3]) * unit);
}

IfcFaces revolution(IfcCurves& curves, const StepInstance& solid) {
    const IfcFrames& frames = curves.frames();
    constexpr int kSteps = 48;  // of a full turn
    const IfcFrame position = frames.axes(solid[1].reference());
    const StepInstance axis = frames.file().read(solid[2].reference());
    const Point3 foot = frames.point(axis[0].reference());
    const Vec3 unit = unitOf(frames.direction(axis[1].reference(), {0, 0, 1}));
    const double angle = solid[3].number().value_or(0) * frames.units().angle;
    if (!std::isfinite(angle)) throw UnreadGeometry("IFCREVOLVEDAREASOLID");
    const double share = std::min(1.0, std::abs(angle) / (2 * std::numbers::pi));
    const int steps = std::max(1, static_cast<int>(std::ceil(share * kSteps)));
    std::vector<IfcFrame> stops;
    for (int i = 0; i <= steps; ++i) {
        const double a = angle * i / steps, c = std::cos(a), s = std::sin(a);
        const auto turned = [&](Vec3 v) {
            return c * v + s * cross(unit, v) + (1 - c) * dot(unit, v) * unit;
        };
        IfcFrame turn{turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}};
        turn.origin = foot + turned({-foot.x, -foot.y, -foot.z});
        stops.push_back(position * turn);
    }
    return swept(curves, checkedArea(curves, solid[0].reference()), stops, share > 1 - 1e-9);
}

Point3 vertexPoint(const IfcFrames& frames, StepId vertex) {
    return frames.point(frames.file().read(vertex)[0].reference());
}

/// An edge without its last point; straight unless its curve is a circle or an ellipse.
std::vector<Point3> edgePoints(const IfcFrames& frames, StepId oriented) {
    const StepInstance use = frames.file().read(oriented);
    const StepInstance edge = frames.file().read(use[2].reference());
    const bool forward = use[3].word() != "F";
    const Point3 start = vertexPoint(frames, edge[0].reference());
    const Point3 end = vertexPoint(frames, edge[1].reference());
    std::vector<Point3> points{start, end};
    const StepInstance conic = frames.file().read(edge[2].reference());
    if (conic.type == "IFCCIRCLE" || conic.type == "IFCELLIPSE") {
        const IfcFrame frame = frames.axes(conic[0].reference());
        const double x = frames.length(conic[1]);
        const double y = conic.type == "IFCELLIPSE" ? frames.length(conic[2]) : x;
        const auto angle = [&](Point3 p) {
            return std::atan2(dot(p - frame.origin, frame.y) / y,
                              dot(p - frame.origin, frame.x) / x);
        };
        constexpr double kTurn = 2 * std::numbers::pi;
        const bool same = edge[3].word() != "F";
        const double from = angle(start);
        double span = (same ? 1 : -1) * (angle(end) - from);
        if (span <= 1e-9) span += kTurn;
        points = ifcArc(frame, x, y, from, from + (same ? span : -span));
        points.front() = start;
        points.back() = end;
    }
    if (!forward) std::reverse(points.begin(), points.end());
    points.pop_back();
    return points;
}

std::vector<Point3> loopPoints(IfcCurves& curves, StepId id) {
    const IfcFrames& frames = curves.frames();
    const StepInstance loop = frames.file().read(id);
    const std::vector<StepValue> values = loop[0].list();
    curves.pay(1 + values.size(), kShared);
    std::vector<Point3> points;
    if (loop.type == "IFCPOLYLOOP") {
        for (const StepValue& value : values) points.push_back(frames.point(value.reference()));
    } else if (loop.type == "IFCEDGELOOP") {
        for (const StepValue& value : values) {
            const std::vector<Point3> edge = edgePoints(frames, value.reference());
            curves.pay(edge.size(), kShared);
            points.insert(points.end(), edge.begin(), edge.end());
        }
    } else {
        throw UnreadGeometry(loop.type.empty() ? "a missing instance" : std::string(loop.type));
    }
    return points;
}

void addShell(IfcCurves& curves, StepId shell, IfcFaces& faces) {
    const IfcFrames& frames = curves.frames();
    curves.pay(1, kShared);
    for (const StepValue& face : frames.file().read(shell)[0].list()) {
        curves.pay(1, kShared);
        for (const StepValue& bound : frames.file().read(face.reference())[0].list())
            faces.addLoop(loopPoints(curves, frames.file().read(bound.reference())[0].reference()));
        faces.endFace();
    }
}

IfcFaces shells(IfcCurves& curves, std::span<const StepValue> ids) {
    IfcFaces faces;
    for (const StepValue& id : ids) addShell(curves, id.reference(), faces);
    return faces;
}

/// Reads IfcTriangulatedFaceSet and IfcPolygonalFaceSet.
IfcFaces faceSet(IfcCurves& curves, const StepInstance& set) {
    const IfcFrames& frames = curves.frames();
    const std::shared_ptr<const std::vector<Point3>> points = curves.points(set[0].reference());
    IfcFaces faces;
    const auto add_loop = [&](const StepValue& indices) {
        std::vector<Point3> loop;
        const std::vector<StepValue> values = indices.list();
        curves.pay(1 + values.size(), kShared);
        for (const StepValue& value : values) {
            const double index = value.number().value_or(0);
            if (!(index >= 1 && index <= static_cast<double>(points->size())))
                throw UnreadGeometry("an index out of its list");
            loop.push_back((*points)[static_cast<std::size_t>(index) - 1]);
        }
        faces.addLoop(loop);
    };
    if (set.type != "IFCPOLYGONALFACESET") {
        for (const StepValue& triangle : set[3].list()) {
            add_loop(triangle);
            faces.endFace();
        }
        return faces;
    }
    for (const StepValue& value : set[2].list()) {
        const StepInstance face = frames.file().read(value.reference());
        add_loop(face[0]);
        for (const StepValue& hole : face[1].list()) add_loop(hole);
        faces.endFace();
    }
    return faces;
}

Polygon rectangleTo(double x, double y) { return {{0, 0}, {x, 0}, {x, y}, {0, y}}; }

IfcFaces primitive(IfcCurves& curves, const StepInstance& item) {
    const IfcFrames& frames = curves.frames();
    if (item.type == "IFCBOUNDINGBOX") {
        IfcFrame frame;
        frame.origin = frames.point(item[0].reference());
        return extruded(curves, {rectangleTo(frames.length(item[1]), frames.length(item[2]))},
                        frame, {0, 0, frames.length(item[3])});
    }
    const IfcFrame frame = frames.axes(item[0].reference());
    if (item.type == "IFCBLOCK")
        return extruded(curves, {rectangleTo(frames.length(item[1]), frames.length(item[2]))},
                        frame, {0, 0, frames.length(item[3])});
    const double radius = frames.length(item[2]);
    return extruded(curves, {ifcPolygon(ifcArc({}, radius, radius, 0, 2 * std::numbers::pi))},
                    frame, {0, 0, frames.length(item[1])});
}

/// Reads the closed curves of a footprint.
IfcFaces footprint(IfcCurves& curves, const StepInstance& set) {
    IfcArea area;
    IfcFrame floor;
    for (const StepValue& element : set[0].list()) {
        const auto curve = curves.curve(element.reference());
        if (curve->empty()) continue;
        curves.pay(curve->size(), kShared);
        floor.origin.z = curve->front().z;
        if (Polygon polygon = ifcPolygon(*curve); !polygon.empty()) area.push_back(polygon);
    }
    if (area.empty()) throw UnreadGeometry(std::string(set.type));
    return extruded(curves, area, floor, {0, 0, kFootprintHeight});
}

}  // namespace

void IfcFaces::addLoop(std::span<const Point3> loop) {
    corners.insert(corners.end(), loop.begin(), loop.end());
    if (corners.size() > IfcShapes::kMaxCorners)
        throw std::runtime_error("a shape of more than 20 million corners");
    loop_ends.push_back(static_cast<std::uint32_t>(corners.size()));
}

void IfcFaces::move(const IfcFrame& frame) {
    for (Point3& corner : corners) corner = frame.at(corner);
}

IfcFaces ifcFaces(IfcCurves& curves, const StepInstance& item) {
    const std::string_view type = item.type;
    if (type == "IFCEXTRUDEDAREASOLID" || type == "IFCEXTRUDEDAREASOLIDTAPERED")
        return extrusion(curves, item);
    if (type == "IFCREVOLVEDAREASOLID") return revolution(curves, item);
    if (type == "IFCSHELLBASEDSURFACEMODEL" || type == "IFCFACEBASEDSURFACEMODEL")
        return shells(curves, item[0].list());
    if (type == "IFCFACETEDBREP" || type == "IFCFACETEDBREPWITHVOIDS" ||
        type == "IFCADVANCEDBREP" || type == "IFCADVANCEDBREPWITHVOIDS") {
        IfcFaces faces;
        addShell(curves, item[0].reference(), faces);
        for (const StepValue& hollow : item[1].list()) addShell(curves, hollow.reference(), faces);
        return faces;
    }
    if (type == "IFCTRIANGULATEDFACESET" || type == "IFCTRIANGULATEDIRREGULARNETWORK" ||
        type == "IFCPOLYGONALFACESET")
        return faceSet(curves, item);
    if (type == "IFCBOUNDINGBOX" || type == "IFCBLOCK" || type == "IFCRIGHTCIRCULARCYLINDER")
        return primitive(curves, item);
    if (type == "IFCGEOMETRICCURVESET" || type == "IFCGEOMETRICSET") return footprint(curves, item);
    throw UnreadGeometry(type.empty() ? "a missing instance" : std::string(type));
}

}  // namespace ispace::ifc
