// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geom/pose.h"
#include "layout/scene.h"
#include "render/lights.h"
#include "render/render.h"
#include "render/surface_set.h"
#include "render/texture.h"

namespace ispace {

/// How surfaces of one material, or of one record, look.
struct Paint {
    Rgb color{};
    float opacity = 1;
    bool is_lit = true, is_ceiling = false, is_floor = false;
};

/// A covering of the floor, in one colour or in squares. It has no height of its own, so that it
/// does not lift what is measured.
struct Covering {
    std::uint32_t label = 0;
    Point2 corner;       ///< relative to the middle of the plan
    Vec2 along, across;  ///< whole extents, at right angles
    std::size_t columns = 1;
    std::vector<std::uint32_t> paints;  ///< of the squares, row by row
    std::uint32_t face = Finish::kNoFace;

    /// The paint at a place; nothing beside it.
    [[nodiscard]] std::optional<std::uint32_t> paintAt(Point2 place) const;
};

/// What does not move, and the shapes of what does.
struct StillSurfaces {
    /// In the frame of Scene::placed, by its index.
    struct Figure {
        std::vector<Mesh> body;
        std::optional<Mesh> view;
        Finish finish;
        std::optional<std::uint32_t> paint;  ///< of the body, if it is not that of its materials
        std::optional<double> person_height = {};  ///< of a person, who is humanParts()
    };

    EmbreeDevice device;
    Vec3 shift;                       ///< takes places of the world to those of the surfaces
    std::vector<Paint> paints;        ///< those of Material first, in its order
    std::vector<Covering> coverings;  ///< later ones lie on earlier ones
    std::vector<Texture> textures;
    std::vector<TexturedFace> faces;  ///< relative to the middle of the plan
    std::optional<SurfaceSet> solid;  ///< what stops light
    std::optional<SurfaceSet> glass;  ///< clear one, which light passes
    std::optional<SurfaceSet> paint;  ///< see PaintedMesh
    Lamps lamps;
    std::vector<Figure> figures;
    double extent = 1;  ///< of the plan, metres
    bool has_ceiling = false;
    std::size_t packet_width = 4;  ///< rays that the processor traces together
};

/// Geometry ids of hits.
enum class SurfaceKind : unsigned { Solid, Body, Person, Glass, Paint, View };

struct RenderScene::Data {
    std::shared_ptr<const StillSurfaces> still;
    SurfaceSet bodies, people, views;

    Data(std::shared_ptr<const StillSurfaces> surfaces, std::span<const Pose3> poses,
         std::span<const Angle> swings = {});
    /// The finish of a triangle at a place: coverings lie on the floor.
    [[nodiscard]] Finish finishAt(const Finish& finish, Point3 place) const;
    [[nodiscard]] const SurfaceSet& set(SurfaceKind kind) const {
        switch (kind) {
            case SurfaceKind::Solid:
                return *still->solid;
            case SurfaceKind::Body:
                return bodies;
            case SurfaceKind::Person:
                return people;
            case SurfaceKind::Glass:
                return *still->glass;
            case SurfaceKind::Paint:
                return *still->paint;
            case SurfaceKind::View:
                break;
        }
        return views;
    }
};

}  // namespace ispace
