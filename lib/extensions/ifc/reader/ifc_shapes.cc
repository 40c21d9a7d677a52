// SPDX-License-Identifier: GPL-3.0-or-later
// The body of a product is the best of its representations: Body, then tessellations, others,
// FootPrint and Box. Mapped shapes are read once and copied, up to ten million corners that are
// kept. Booleans: unions append, differences and half-spaces become cuts that sections apply later;
// what is not understood leaves the solid whole and is counted.
#include "extensions/ifc/reader/ifc_shapes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ispace::ifc {

namespace {

/// Corners of mapped shapes that are kept for the next use.
constexpr std::size_t kMaxKeptCorners = 10'000'000;
/// Corners that are copied and cut in the time of one unit of Budget.
constexpr std::size_t kCornersPerUnit = 4;
/// Beyond any building, in metres: how far limits of half-spaces are drawn out.
constexpr double kFar = 10'000;

/// Ranks a representation as source of the body; 0: unsuitable.
int rankOf(const StepInstance& representation) {
    constexpr std::array<std::string_view, 9> kOthers{"Axis",      "Annotation", "Plan",
                                                      "Profile",   "Reference",  "Lighting",
                                                      "Clearance", "CoG",        "Surface"};
    const std::string name = representation[1].text();
    if (name == "Body") return 5;
    if (name == "Facetation" || name == "Tessellation" || name == "Body-Fallback") return 4;
    if (name == "FootPrint") return 2;
    if (name == "Box") return 1;
    return std::find(kOthers.begin(), kOthers.end(), name) == kOthers.end() ? 3 : 0;
}

std::size_t cornersOf(std::span<const IfcSolid> shape) {
    std::size_t corners = 0;
    for (const IfcSolid& solid : shape) {
        corners += solid.body.corners.size();
        for (const IfcCut& cut : solid.cuts)
            if (cut.limit) corners += cut.limit->corners.size();
    }
    return corners;
}

/// The prism over a boundary in the plane of `position`, without ends.
IfcFaces prismOver(const Polygon& boundary, const IfcFrame& position) {
    IfcFaces faces;
    const auto at = [&](Point2 p, double z) { return position.at({p.x, p.y, z}); };
    for (const double z : {-kFar, kFar}) {
        std::vector<Point3> cap;
        for (const Point2 p : boundary) cap.push_back(at(p, z));
        faces.addLoop(cap);
        faces.endFace();
    }
    forEachEdge(boundary, [&](const Segment2& edge) {
        faces.addLoop(
            std::array{at(edge.a, -kFar), at(edge.b, -kFar), at(edge.b, kFar), at(edge.a, kFar)});
        faces.endFace();
    });
    return faces;
}

}  // namespace

void IfcShapes::pay(std::span<const IfcSolid> part, const char* cause) {
    pay(part.size(), cornersOf(part), cause);
}

void IfcShapes::pay(std::size_t solids, std::size_t corners, const char* cause) {
    if (!work_.take(solids + corners / kCornersPerUnit))
        throw std::runtime_error(std::string(cause) + " make " + work_.excess());
}

void IfcShapes::append(Growing& shape, const Growing& part, const IfcFrame& frame) {
    pay(part.solids.size(), part.corners, "mapped shapes");
    shape.corners += part.corners;
    if (shape.corners > kMaxCorners)
        throw std::runtime_error("a shape of more than 20 million corners");
    for (const IfcSolid& solid : part.solids) {
        IfcSolid& copy = shape.solids.emplace_back(solid);
        copy.body.move(frame);
        for (IfcCut& cut : copy.cuts) {
            if (cut.half_space)
                cut.half_space = {frame.at(cut.half_space->at),
                                  unitOf(frame.turned(cut.half_space->normal))};
            if (cut.limit) cut.limit->move(frame);
        }
    }
}

IfcShape IfcShapes::shapeOf(StepId definition, bool is_hole) {
    std::vector<std::pair<int, StepInstance>> ranked;
    const StepInstance all = frames_.file().read(definition);
    const auto check = [this](StepId id, const StepInstance& read) {
        if (id != 0 && read.type.empty()) ++unread_["a missing shape"];
    };
    check(definition, all);
    for (const StepValue& value : all[2].list()) {
        curves_.pay(1, "shared shapes");
        StepInstance representation = frames_.file().read(value.reference());
        check(value.reference(), representation);
        const bool is_reference = is_hole && representation[1].text() == "Reference";
        if (const int rank = is_reference ? 1 : rankOf(representation); rank > 0)
            ranked.emplace_back(rank, std::move(representation));
    }
    Growing shape;
    for (int rank = 5; rank > 0 && shape.solids.empty(); --rank)
        for (const auto& [own, representation] : ranked)
            if (own == rank) addItems(representation, shape, 0);
    return std::move(shape.solids);
}

void IfcShapes::addItems(const StepInstance& representation, Growing& shape, int depth) {
    for (const StepValue& item : representation[3].list()) {
        try {
            addItem(item.reference(), shape, depth);
        } catch (const UnreadGeometry& part) {
            ++unread_[part.what()];
        }
    }
}

void IfcShapes::addItem(StepId id, Growing& shape, int depth) {
    if (depth > kMaxIfcDepth) throw UnreadGeometry("shapes in a loop");
    curves_.pay(1, "shared shapes");
    const StepInstance item = frames_.file().read(id);
    if (item.type == "IFCMAPPEDITEM") return addMapped(item, shape, depth);
    if (item.type == "IFCBOOLEANRESULT" || item.type == "IFCBOOLEANCLIPPINGRESULT")
        return addBoolean(item, shape, depth);
    if (item.type == "IFCCSGSOLID") return addItem(item[0].reference(), shape, depth + 1);
    IfcFaces faces = ifcFaces(curves_, item);
    if (faces.corners.empty()) throw UnreadGeometry(std::string(item.type) + " without faces");
    shape.corners += faces.corners.size();
    shape.solids.push_back({std::move(faces), {}});
}

void IfcShapes::addMapped(const StepInstance& item, Growing& shape, int depth) {
    const StepId source = item[0].reference();
    const StepInstance map = frames_.file().read(source);
    const IfcFrame frame =
        frames_.transformation(item[1].reference()) * frames_.axes(map[0].reference());
    std::shared_ptr<const Growing> part;
    if (const auto known = mapped_.find(source); known != mapped_.end()) {
        part = known->second;
        if (part == nullptr) throw UnreadGeometry("shapes in a loop");
    } else {
        mapped_.emplace(source, nullptr);
        Growing read;
        addItems(frames_.file().read(map[1].reference()), read, depth + 1);
        part = std::make_shared<const Growing>(std::move(read));
        if (kept_ + part->corners <= kMaxKeptCorners) {
            kept_ += part->corners;
            mapped_[source] = part;
        } else {
            mapped_.erase(source);
        }
    }
    append(shape, *part, frame);
}

IfcCut IfcShapes::cutBy(StepId operand, bool keeps_inside, int depth) {
    const StepInstance item = frames_.file().read(operand);
    IfcCut cut;
    if (item.type.find("HALFSPACE") == std::string_view::npos) {
        Growing other;
        addItem(operand, other, depth + 1);
        if (keeps_inside || other.solids.size() != 1 || !other.solids.front().cuts.empty())
            throw UnreadGeometry("IFCBOOLEANRESULT of two solids");
        cut.limit = std::move(other.solids.front().body);
        return cut;
    }
    const StepInstance surface = frames_.file().read(item[0].reference());
    if (surface.type != "IFCPLANE")
        throw UnreadGeometry("a half-space of " + std::string(surface.type));
    const IfcFrame plane = frames_.axes(surface[0].reference());
    const bool is_below = item[1].word() != "F";
    cut.half_space = {plane.origin, is_below == keeps_inside ? -plane.z : plane.z};
    if (item.type == "IFCPOLYGONALBOUNDEDHALFSPACE") {
        const auto curve = curves_.curve(item[3].reference());
        curves_.pay(2 * curve->size(), "half-spaces");  // a prism has six corners for each
        const Polygon boundary = ifcPolygon(*curve);
        if (boundary.empty() || keeps_inside) throw UnreadGeometry(std::string(item.type));
        cut.limit = prismOver(boundary, frames_.axes(item[2].reference()));
    }
    return cut;
}

void IfcShapes::addBoolean(const StepInstance& result, Growing& shape, int depth) {
    const std::string_view operation = result[0].word();
    Growing first;
    addItem(result[1].reference(), first, depth + 1);
    if (operation == "UNION") {
        append(shape, first, {});
        return addItem(result[2].reference(), shape, depth + 1);
    }
    try {
        const IfcCut cut = cutBy(result[2].reference(), operation == "INTERSECTION", depth);
        if (cut.limit) {
            const std::size_t corners = cut.limit->corners.size();
            curves_.pay(first.solids.size() * (corners / kCornersPerUnit), "cuts");
            first.corners += first.solids.size() * corners;
        }
        for (IfcSolid& solid : first.solids) solid.cuts.push_back(cut);
    } catch (const UnreadGeometry& part) {
        ++unread_[part.what()];  // the solid stays whole
    }
    append(shape, first, {});
}

}  // namespace ispace::ifc
