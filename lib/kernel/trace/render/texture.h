// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/kernel/trace/render: pictures on surfaces. Files are decoded by the confined
// reader of pictures, since they may come with a room from elsewhere; all textures of a scene share
// one bound of pixels.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/confined.h"
#include "env/environment.h"
#include "raster/picture.h"
#include "trace/render/render.h"

namespace ispace {

/// A picture that covers a surface from edge to edge: with w pixels across, the centre of the first
/// lies 1 / (2 w) from the edge. Bilinear between the centres, in linear light.
class Texture {
  public:
    explicit Texture(ColorPicture picture) : picture_(std::move(picture)) {}

    /// Returns the colour at (u, v), with (0, 0) the upper left corner; clamped at the edges. Where
    /// the picture is transparent, returns `behind`.
    [[nodiscard]] Rgb at(double u, double v, const Rgb& behind) const;

  private:
    ColorPicture picture_;
};

/// A rectangle in space that a texture covers.
struct TexturedFace {
    Point3 corner;     ///< the upper left one of the picture
    Vec3 right, down;  ///< full extents; the picture is upright along right x down, and turned to
                       ///< be upright and readable from the other side
    double reach = 0;  ///< maximum distance of parallel triangles that belong to the face
    std::uint32_t texture = 0;

    /// True if a triangle with these corners belongs to the face.
    [[nodiscard]] bool holds(const Point3& a, const Point3& b, const Point3& c) const;
    [[nodiscard]] Rgb colorAt(Point3 place, Vec3 direction, const std::vector<Texture>& textures,
                              const Rgb& behind) const;
};

bool hasTexture(const Record& record);

/// Returns the faces of an element that its texture covers, in the world; of a floor, its
/// rectangle.
std::vector<TexturedFace> texturedFaces(const Element& element);

/// Reads textures, each file once.
class TextureReader {
  public:
    /// Reads the record's texture. \returns its index in `textures`. An unreadable file is reported
    /// as a finding and replaced by a white picture.
    std::uint32_t read(const Record& record, std::vector<Texture>& textures, Diagnostics& findings);

  private:
    [[nodiscard]] ColorPicture load(const std::string& file);

    std::map<std::string, std::uint32_t> known_;
    std::int64_t pixels_ = 0;
    ConfinedReader pictures_;
};

}  // namespace ispace
