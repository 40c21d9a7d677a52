// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of IFC import: houses of tessellated walls, as Revit's reference view has them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/number.h"
#include "extensions/ifc/tests/test_ifc.h"
#include "geom/point.h"

namespace ispace::ifc {

/// A house with rooms of 4 m x 5 m and 3.9 m x 5 m behind walls of 0.3 m, an inner wall of 0.1 m,
/// doors of 0.9 m (front, inner) and windows of 1.5 m and 1.2 m with sills of 0.9 m.
struct IfcHouse {
    enum class Holes : std::uint8_t { Body, Reference, WithoutBody, Absent };

    bool holes_in_mesh = true;  ///< the walls' meshes have the holes
    bool triangles = true;      ///< else polygons
    Holes holes = Holes::Body;  ///< of the IfcOpeningElement
    bool spaces = true;
    int storeys = 1;                        ///< 3 m high each
    double turned = 0;                      ///< degrees
    double offset = 0;                      ///< metres, of the house from the origin
    double leaf_from = 0.4, leaf_to = 0.6;  ///< doors and windows, as shares of the wall

    /// Both rooms and the doorways of a ground floor.
    static constexpr double kArea = 20 + 19.5 + 0.9 * 0.3 + 0.9 * 0.1;
};

class IfcHouseText {
  public:
    explicit IfcHouseText(const IfcHouse& house) : house_(house) {}

    std::string text() {
        std::string storeys;
        for (int k = 0; k < house_.storeys; ++k) storeys += (k == 0 ? "" : ",") + storey(k);
        const std::string building = add("IFCBUILDING('b',$,'b',$,$,$,$,$,.ELEMENT.,$,$,$)");
        add("IFCRELAGGREGATES('r',$,$,$,#1,(" + building + "))");
        add("IFCRELAGGREGATES('r',$,$,$," + building + ",(" + storeys + "))");
        return ifcWith(data_);
    }

  private:
    /// A box, as the wall and its openings are: x, y and z from and to.
    struct Box {
        std::array<double, 3> low, high;
    };
    struct Hole {
        double from, to, sill, top;  ///< along the wall from its lower end, and above the floor
    };

    std::string add(const std::string& instance) {
        const std::string id = "#" + std::to_string(next_++);
        data_ += id + '=' + instance + ";\n";
        return id;
    }

    static std::string real(double value) {
        const std::string text = formatFixed(value, 9);
        return text;
    }

    /// Returns the IfcProductDefinitionShape of faces, each a list of corners.
    std::string shape(const std::vector<std::vector<Point3>>& faces, const char* name,
                      bool triangles) {
        std::string points, polygons;
        std::map<std::array<double, 3>, int> index;
        const auto at = [&](const Point3& p) {
            const auto [known, is_new] =
                index.try_emplace({p.x, p.y, p.z}, static_cast<int>(index.size()) + 1);
            if (is_new) {
                const double a = house_.turned * std::acos(-1.0) / 180;
                points += (known->second == 1 ? "(" : ",(") +
                          real(house_.offset + std::cos(a) * p.x - std::sin(a) * p.y) + ',' +
                          real(std::sin(a) * p.x + std::cos(a) * p.y) + ',' + real(p.z) + ')';
            }
            return std::to_string(known->second);
        };
        for (const std::vector<Point3>& face : faces) {
            if (triangles) {
                for (std::size_t i = 2; i < face.size(); ++i)
                    polygons += (polygons.empty() ? "(" : ",(") + at(face[0]) + ',' +
                                at(face[i - 1]) + ',' + at(face[i]) + ')';
                continue;
            }
            std::string list;
            for (const Point3& p : face) list += (list.empty() ? "" : ",") + at(p);
            polygons +=
                (polygons.empty() ? "" : ",") + add("IFCINDEXEDPOLYGONALFACE((" + list + "))");
        }
        const std::string list = add("IFCCARTESIANPOINTLIST3D((" + points + "))");
        const std::string set =
            add(triangles ? "IFCTRIANGULATEDFACESET(" + list + ",$,.T.,(" + polygons + "),$)"
                          : "IFCPOLYGONALFACESET(" + list + ",.T.,(" + polygons + "),$)");
        const std::string body = add("IFCSHAPEREPRESENTATION($,'" + std::string(name) +
                                     "','Tessellation',(" + set + "))");
        return add("IFCPRODUCTDEFINITIONSHAPE($,$,(" + body + "))");
    }

    static std::vector<std::vector<Point3>> facesOf(const Box& box) {
        const auto& [a, b] = box;
        return {{{a[0], a[1], a[2]}, {b[0], a[1], a[2]}, {b[0], b[1], a[2]}, {a[0], b[1], a[2]}},
                {{a[0], a[1], b[2]}, {b[0], a[1], b[2]}, {b[0], b[1], b[2]}, {a[0], b[1], b[2]}},
                {{a[0], a[1], a[2]}, {b[0], a[1], a[2]}, {b[0], a[1], b[2]}, {a[0], a[1], b[2]}},
                {{a[0], b[1], a[2]}, {b[0], b[1], a[2]}, {b[0], b[1], b[2]}, {a[0], b[1], b[2]}},
                {{a[0], a[1], a[2]}, {a[0], b[1], a[2]}, {a[0], b[1], b[2]}, {a[0], a[1], b[2]}},
                {{b[0], a[1], a[2]}, {b[0], b[1], a[2]}, {b[0], b[1], b[2]}, {b[0], a[1], b[2]}}};
    }

    /// The faces of a wall with its holes: of the boxes between their edges, without those that
    /// two boxes share.
    static std::vector<std::vector<Point3>> facesOf(const Box& wall,
                                                    const std::vector<Hole>& holes) {
        const std::size_t along = wall.high[0] - wall.low[0] > wall.high[1] - wall.low[1] ? 0 : 1;
        std::vector<double> steps{wall.low[along], wall.high[along]},
            levels{wall.low[2], wall.high[2]};
        for (const Hole& hole : holes) {
            for (const double x : {hole.from, hole.to}) steps.push_back(wall.low[along] + x);
            for (const double z : {hole.sill, hole.top}) levels.push_back(wall.low[2] + z);
        }
        for (auto* list : {&steps, &levels}) {
            std::sort(list->begin(), list->end());
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
        std::map<std::vector<std::array<double, 3>>, std::pair<int, std::vector<Point3>>> faces;
        for (std::size_t i = 1; i < steps.size(); ++i)
            for (std::size_t k = 1; k < levels.size(); ++k) {
                const double x = (steps[i - 1] + steps[i]) / 2 - wall.low[along];
                const double z = (levels[k - 1] + levels[k]) / 2 - wall.low[2];
                if (std::any_of(holes.begin(), holes.end(), [&](const Hole& hole) {
                        return x > hole.from && x < hole.to && z > hole.sill && z < hole.top;
                    }))
                    continue;
                Box box = wall;
                box.low[along] = steps[i - 1];
                box.high[along] = steps[i];
                box.low[2] = levels[k - 1];
                box.high[2] = levels[k];
                for (const std::vector<Point3>& face : facesOf(box)) {
                    std::vector<std::array<double, 3>> key;
                    for (const Point3& p : face) key.push_back({p.x, p.y, p.z});
                    std::sort(key.begin(), key.end());
                    auto& [count, corners] = faces[key];
                    ++count;
                    corners = face;
                }
            }
        std::vector<std::vector<Point3>> once;
        for (const auto& [key, face] : faces)
            if (face.first == 1) once.push_back(face.second);
        return once;
    }

    void wall(const Box& box, const std::vector<Hole>& holes, std::string& elements) {
        const std::string body = shape(house_.holes_in_mesh ? facesOf(box, holes) : facesOf(box),
                                       "Body", house_.triangles);
        const std::string wall =
            add("IFCWALL('w',$,'Basic Wall',$,$," + place_ + ',' + body + ",$,$)");
        elements += (elements.empty() ? "" : ",") + wall;
        const std::size_t along = box.high[0] - box.low[0] > box.high[1] - box.low[1] ? 0 : 1;
        for (const Hole& hole : holes) {
            Box gap = box;
            gap.low[along] = box.low[along] + hole.from;
            gap.high[along] = box.low[along] + hole.to;
            gap.low[2] = box.low[2] + hole.sill;
            gap.high[2] = box.low[2] + hole.top;
            Box leaf = gap;
            const double thickness = box.high[1 - along] - box.low[1 - along];
            leaf.low[1 - along] += house_.leaf_from * thickness;
            leaf.high[1 - along] = gap.low[1 - along] + house_.leaf_to * thickness;
            const bool is_door = hole.sill == 0;
            const char* const name = !is_door     ? "Fixed:1"
                                     : along == 0 ? "Front door:2"
                                                  : "Inner door:3";
            const std::string filler =
                add(std::string(is_door ? "IFCDOOR" : "IFCWINDOW") + "('d',$,'" + name + "',$,$," +
                    place_ + ',' + shape(facesOf(leaf), "Body", house_.triangles) + ",$," +
                    real(hole.top - hole.sill) + ',' + real(hole.to - hole.from) + ",$,$,$)");
            elements += ',' + filler;
            if (house_.holes == IfcHouse::Holes::Absent) continue;
            const std::string volume =
                house_.holes == IfcHouse::Holes::WithoutBody
                    ? "$"
                    : shape(facesOf(gap),
                            house_.holes == IfcHouse::Holes::Body ? "Body" : "Reference", false);
            const std::string opening =
                add("IFCOPENINGELEMENT('o',$,'o',$,$," + place_ + ',' + volume + ",$,.OPENING.)");
            add("IFCRELVOIDSELEMENT('r',$,$,$," + wall + ',' + opening + ')');
            add("IFCRELFILLSELEMENT('r',$,$,$," + opening + ',' + filler + ')');
        }
    }

    std::string storey(int k) {
        const double z = 3 * k, top = z + 2.7;
        const std::string axes =
            add("IFCAXIS2PLACEMENT3D(" + add("IFCCARTESIANPOINT((0.,0.,0.))") + ",$,$)");
        place_ = add("IFCLOCALPLACEMENT($," + axes + ')');
        std::string elements, rooms;
        const double sill = k == 0 ? 0 : 0.9;
        wall({{-0.3, -0.3, z}, {8.3, 0, top}}, {{2.5, 3.4, sill, 2.1}, {5, 6.5, 0.9, 2.1}},
             elements);
        wall({{8, 0, z}, {8.3, 5, top}}, {{1, 2.2, 0.9, 2.1}}, elements);
        wall({{-0.3, 5, z}, {8.3, 5.3, top}}, {{1, 2.5, 0.9, 2.1}, {5, 6.5, 0.9, 2.1}}, elements);
        wall({{-0.3, 0, z}, {0, 5, top}}, {{2, 3.2, 0.9, 2.1}}, elements);
        wall({{4, 0, z}, {4.1, 5, top}}, {{1, 1.9, 0, 2.1}}, elements);
        const std::string storey = add("IFCBUILDINGSTOREY('s',$,'Level " + std::to_string(k + 1) +
                                       "',$,$,$,$,$,.ELEMENT.," + real(z) + ')');
        add("IFCRELCONTAINEDINSPATIALSTRUCTURE('r',$,$,$,(" + elements + ")," + storey + ')');
        if (!house_.spaces) return storey;
        for (const Box& box : {Box{{0, 0, z}, {4, 5, top}}, Box{{4.1, 0, z}, {8, 5, top}}})
            rooms += (rooms.empty() ? "" : ",") +
                     add("IFCSPACE('p',$,'" + std::to_string(k) + "',$,$," + place_ + ',' +
                         shape(facesOf(box), "Body", false) + ",'Room',.ELEMENT.,$,$)");
        add("IFCRELAGGREGATES('r',$,$,$," + storey + ",(" + rooms + "))");
        return storey;
    }

    IfcHouse house_;
    int next_ = 100;
    std::string data_, place_;
};

inline std::string ifcHouse(const IfcHouse& house) { return IfcHouseText(house).text(); }

}  // namespace ispace::ifc
