// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace/render: the data of a RenderScene. Static surfaces are built once and
// shared by all scenes that at() returns; movable bodies are built for each. Coordinates are
// relative to the middle of the plan, so that float32 resolves micrometres. Immutable once built,
// thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "env/mesh.h"
#include "env/projector_beam.h"
#include "geom/pose.h"
#include "scene/scene.h"
#include "trace/embree_bodies.h"
#include "trace/render/lights.h"
#include "trace/render/render.h"
#include "trace/render/texture.h"
#include "trace/triangle_set.h"

namespace ispace {

/// Record and appearance of a surface.
struct SurfaceFinish {
    static constexpr std::uint32_t kNoFace = ~0U;

    std::uint32_t label = 0;       ///< index of its record, plus 1
    std::uint32_t paint = 0;       ///< index in StillSurfaces::paints
    std::uint32_t face = kNoFace;  ///< the textured face that contains it
};

/// Triangles with their finish, in coordinates relative to the middle of the plan.
struct FinishedSoup {
    TriangleSoup triangles;
    std::vector<SurfaceFinish> finishes, round_finishes = {};

    void add(const Mesh& mesh, SurfaceFinish finish, Vec3 shift);
};

/// Bodies of people, one finish each, in the same coordinates. Labels are the bodies' owners.
struct FinishedBodies {
    std::vector<TracedBody> bodies;
    std::vector<SurfaceFinish> finishes;
};

/// Surfaces or bodies, ready to be traced. Its hits hold this geometry id. Bodies require a
/// BodyQuery.
class SurfaceSet {
  public:
    /// \throws std::runtime_error if Embree fails, std::bad_alloc if it is out of memory
    SurfaceSet(RTCDeviceTy* device, const FinishedSoup& soup, unsigned geometry);
    SurfaceSet(RTCDeviceTy* device, FinishedBodies bodies, unsigned geometry);

    [[nodiscard]] bool empty() const { return finishes_.empty(); }
    [[nodiscard]] const TriangleSet& triangles() const { return triangles_; }
    [[nodiscard]] const TracedBody& body(std::size_t index) const { return bodies_[index]; }
    /// Returns the finish of a surface or body.
    [[nodiscard]] const SurfaceFinish& finish(std::size_t index) const { return finishes_[index]; }
    /// Labels of the surfaces or bodies in the pictures' range: 65535 stands for all larger ones.
    /// Stored separately, since label pictures read only these.
    [[nodiscard]] std::span<const std::uint16_t> labels() const { return labels_; }
    [[nodiscard]] RTCSceneTy* scene() const { return scene_.get(); }

  private:
    void addLabels();

    TriangleSet triangles_;
    std::vector<TracedBody> bodies_;
    std::vector<SurfaceFinish> finishes_;  // of the surfaces or bodies
    std::vector<std::uint16_t> labels_;
    EmbreeSceneHandle scene_;
};

/// Appearance of the surfaces of one material, or of one record.
struct Paint {
    Rgb color{};
    float opacity = 1;
    bool is_lit = true, is_ceiling = false, is_floor = false;
    bool glows = false;  ///< it gives off its colour
};

/// A floor covering, in one colour or in squares. Without thickness, so that measured depths do not
/// change.
struct Covering {
    std::uint32_t label = 0;
    Point2 corner;       ///< relative to the middle of the plan
    Vec2 along, across;  ///< full extents, perpendicular
    std::size_t columns = 1;
    std::vector<std::uint32_t> paints;  ///< of the squares, row by row
    std::uint32_t face = SurfaceFinish::kNoFace;

    /// Returns the paint at a point; empty outside.
    [[nodiscard]] std::optional<std::uint32_t> paintAt(Point2 place) const;
};

/// The light of a `projector` that is on.
struct ThrownPicture {
    static constexpr std::uint32_t kPlain = ~0U;

    ProjectorBeam beam;  ///< relative to the middle of the plan
    Rgb color{};
    std::uint32_t texture = kPlain;
};

/// Static surfaces, and the shapes of movable ones.
struct StillSurfaces {
    /// In the frame of Scene::placed, by its index.
    struct Figure {
        std::vector<Mesh> body;
        std::optional<Mesh> view;
        SurfaceFinish finish;
        std::optional<std::uint32_t> paint;        ///< of the body, if different from its materials
        std::optional<double> person_height = {};  ///< set for a person, see personParts()
        std::shared_ptr<const PersonFigure> person_figure = {};
    };

    EmbreeDevice device;
    Vec3 shift;                       ///< offset from world coordinates to those of the surfaces
    std::vector<Paint> paints;        ///< those of Material first, in its order
    std::vector<Covering> coverings;  ///< later ones cover earlier ones
    std::vector<Texture> textures;
    std::vector<TexturedFace> faces;  ///< relative to the middle of the plan
    std::optional<SurfaceSet> solid;  ///< surfaces that stop light
    std::optional<SurfaceSet> glass;  ///< clear glass, which light passes
    std::optional<SurfaceSet> paint;  ///< see PaintedMesh
    Lamps lamps;
    std::vector<ThrownPicture> thrown;
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
    /// Returns the finish of a triangle at a point: floor coverings replace the floor's finish.
    [[nodiscard]] SurfaceFinish finishAt(const SurfaceFinish& finish, Point3 place) const;
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
