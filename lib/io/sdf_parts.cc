// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sdf_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number.h"
#include "geom/tolerance.h"
#include "io/robot_xml.h"
#include "layout/robot.h"
#include "plan/elements.h"

namespace ispace {

namespace {

/// Plates are this thick, metres.
constexpr double kPlateThickness = 0.001;

Point2 toLocal(const Pose2& frame, Point2 p) {
    const Vec2 along = unitVector(frame.heading), way = p - frame.position;
    return {dot(way, along), cross(along, way)};
}

/// Without corners on the line between their neighbours.
Polygon cornersOf(const Polygon& footprint) {
    Polygon corners;
    const std::size_t count = footprint.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 before = footprint[(i + count - 1) % count], here = footprint[i];
        const Vec2 chord = footprint[(i + 1) % count] - before;
        if (std::abs(cross(chord, here - before)) > kContactTolerance * length(chord))
            corners.push_back(here);
    }
    return corners;
}

bool isRectangle(const Polygon& corners) {
    if (corners.size() != 4) return false;
    const Vec2 a = corners[1] - corners[0], b = corners[3] - corners[0];
    return length((corners[2] - corners[1]) - b) <= kContactTolerance &&
           std::abs(dot(a, b)) <= kContactTolerance * std::max(length(a), length(b));
}

/// A rectangle as a box; which of its sides is the length depends on where it should point.
SdfPart boxPart(const Polygon& corners, double bottom, double top, bool is_framed) {
    SdfPart part;
    Vec2 along = corners[1] - corners[0], across = corners[3] - corners[0];
    part.place = {corners[0].x + (along.x + across.x) / 2, corners[0].y + (along.y + across.y) / 2,
                  (bottom + top) / 2};
    const bool swaps = is_framed ? std::abs(along.y) > std::abs(along.x) * (1 + kContactTolerance)
                                 : length(across) > length(along);
    if (swaps) {
        std::swap(along, across);
        across = -across;
    }
    if (along.x < 0 || (along.x == 0 && along.y < 0)) along = -along;
    part.length = length(along);
    part.width = length(across);
    part.height = top - bottom;
    part.heading = directionOf(along.x, along.y);
    return part;
}

SdfPart prismPart(const Prism& prism, const Pose2& frame, double base, bool is_framed) {
    const double bottom = prism.bottom - base, top = prism.top - base;
    SdfPart part;
    if (prism.curve && prism.curve->half_length == prism.curve->half_width) {
        const Point2 center = toLocal(frame, prism.curve->center);
        part.shape = SdfPart::Shape::Cylinder;
        part.place = {center.x, center.y, (bottom + top) / 2};
        part.radius = prism.curve->half_length;
        part.height = top - bottom;
    } else {
        Polygon local;
        local.reserve(prism.footprint.size());
        for (const Point2 p : prism.footprint) local.push_back(toLocal(frame, p));
        Polygon corners = cornersOf(local);
        if (isRectangle(corners)) {
            part = boxPart(corners, bottom, top, is_framed);
        } else {
            part.shape = SdfPart::Shape::Polyline;
            part.place = {0, 0, bottom};
            part.height = top - bottom;
            part.outline = std::move(corners);
        }
    }
    part.material = prism.material;
    return part;
}

/// An upright sheet as a thin wall.
Prism thinWall(const Sheet& sheet) {
    const Vec2 along = sheet.line.b - sheet.line.a;
    const Vec2 side = kSheetThickness / 2 / length(along) * perpendicular(along);
    return {{sheet.line.a - side, sheet.line.b - side, sheet.line.b + side, sheet.line.a + side},
            sheet.bottom,
            sheet.top,
            sheet.material};
}

/// Things, furniture and pillars stand somewhere: their models do so, too.
bool hasFrame(const Record& record) {
    const RecordType type = record.schema().type;
    return (type == RecordType::Other || type == RecordType::Infra) &&
           record.find("at") != nullptr && record.keyword() != "mesh";
}

void setPose(pugi::xml_node node, const SdfPart& part) {
    if (part.place == Point3() && part.heading == Angle()) return;
    addText(node, "pose",
            lengthsText({part.place.x, part.place.y, part.place.z}) + " 0 0 " +
                radiansText(part.heading));
}

void addGeometry(pugi::xml_node parent, const SdfPart& part, const std::string& mesh_file) {
    pugi::xml_node geometry = parent.append_child("geometry");
    switch (part.shape) {
        case SdfPart::Shape::Box:
            addText(geometry.append_child("box"), "size",
                    lengthsText({part.length, part.width, part.height}));
            return;
        case SdfPart::Shape::Cylinder: {
            pugi::xml_node cylinder = geometry.append_child("cylinder");
            addText(cylinder, "radius", lengthsText({part.radius}));
            addText(cylinder, "length", lengthsText({part.height}));
            return;
        }
        case SdfPart::Shape::Ball:
            addText(geometry.append_child("sphere"), "radius", lengthsText({part.radius}));
            return;
        case SdfPart::Shape::Polyline: {
            pugi::xml_node polyline = geometry.append_child("polyline");
            for (const Point2 p : part.outline) addText(polyline, "point", lengthsText({p.x, p.y}));
            addText(polyline, "height", lengthsText({part.height}));
            return;
        }
        case SdfPart::Shape::Mesh: {
            pugi::xml_node mesh = geometry.append_child("mesh");
            addText(mesh, "uri", mesh_file);
            pugi::xml_node submesh = mesh.append_child("submesh");
            addText(submesh, "name", part.mesh);
            addText(submesh, "center", "false");
            return;
        }
    }
}

}  // namespace

std::vector<SdfPart> sdfParts(const Body& body, const Pose2& frame, double bottom, bool is_framed,
                              const std::string& mesh) {
    std::vector<SdfPart> parts;
    for (const Prism& prism : body.prisms)
        parts.push_back(prismPart(prism, frame, bottom, is_framed));
    for (const Sheet& sheet : body.sheets)
        parts.push_back(prismPart(thinWall(sheet), frame, bottom, is_framed));
    for (const Plate& plate : body.plates) {
        parts.push_back(
            prismPart({plate.outline, plate.z, plate.z + kPlateThickness, plate.material}, frame,
                      bottom, is_framed));
        parts.back().is_solid = !plate.visual_only;
    }
    for (const Mesh& part : body.meshes) {
        parts.emplace_back();
        parts.back().shape = SdfPart::Shape::Mesh;
        parts.back().mesh = mesh;
        parts.back().material = part.material;
    }
    return parts;
}

FramedSdfParts sdfParts(const Element& element) {
    Pose2 frame;
    double bottom = 0;
    const bool is_framed = hasFrame(element.record);
    if (is_framed) {
        frame = floorPoseOf(element.record);
        const Tuple& at = element.record.tuple("at");
        if (at.size() > 2) bottom = at[2];
    }
    return {{{frame.position.x, frame.position.y, bottom}, wrapped(frame.heading), {}, {}},
            sdfParts(element.body, frame, bottom, is_framed, element.id)};
}

SdfPart sdfPart(const BodyPart& part) {
    SdfPart out;
    out.place = {part.center.x, part.center.y, (part.bottom + part.top) / 2};
    out.height = part.top - part.bottom;
    out.material = part.material;
    if (part.radius > 0) {
        out.shape = part.is_ball ? SdfPart::Shape::Ball : SdfPart::Shape::Cylinder;
        out.radius = part.radius;
    } else {
        out.length = 2 * part.half_length;
        out.width = 2 * part.half_width;
    }
    return out;
}

void addSdfMaterial(pugi::xml_node visual, Material material) {
    const Color color = displayColor(material);
    std::string text;
    for (const double part : {color.red, color.green, color.blue, color.alpha})
        text.append(text.empty() ? "" : " ").append(formatFixed(part, 4));
    pugi::xml_node node = visual.append_child("material");
    addText(node, "ambient", text);
    addText(node, "diffuse", text);
}

void addSdfParts(pugi::xml_node link, const std::vector<SdfPart>& parts,
                 const std::string& mesh_file, XmlNames& names) {
    int number = 0;
    for (const SdfPart& part : parts) {
        const std::string name = "part" + std::to_string(++number);
        if (part.is_solid) {
            pugi::xml_node collision = link.append_child("collision");
            collision.append_attribute("name").set_value(names.take(name).c_str());
            setPose(collision, part);
            addGeometry(collision, part, mesh_file);
        }
        pugi::xml_node visual = link.append_child("visual");
        visual.append_attribute("name").set_value(names.take(name + "_visual").c_str());
        setPose(visual, part);
        addGeometry(visual, part, mesh_file);
        addSdfMaterial(visual, part.material);
    }
}

}  // namespace ispace
