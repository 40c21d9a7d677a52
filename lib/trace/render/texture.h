// SPDX-License-Identifier: GPL-3.0-or-later
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

/// A picture that covers a surface from edge to edge: of w pixels side by side, the middle of the
/// first lies half of 1 / w from the edge. Bilinear between the middles, in linear light.
class Texture {
  public:
    explicit Texture(ColorPicture picture) : picture_(std::move(picture)) {}

    /// The colour at (u, v), (0, 0) being the upper left corner; beyond the edges that of the edge.
    /// Where the picture is clear, `behind` shows.
    [[nodiscard]] Rgb at(double u, double v, const Rgb& behind) const;

  private:
    ColorPicture picture_;
};

/// A rectangle in space that a texture covers.
struct TexturedFace {
    Point3 corner;     ///< the upper left one of the picture
    Vec3 right, down;  ///< whole extents; a viewer who looks along their cross product sees it so,
                       ///< from the other side the picture is turned to be upright and readable
    double reach = 0;  ///< parallel triangles this near to the plane are parts of it
    std::uint32_t texture = 0;

    /// True if a triangle of these corners is a part of it.
    [[nodiscard]] bool holds(const Point3& a, const Point3& b, const Point3& c) const;
    [[nodiscard]] Rgb colorAt(Point3 place, Vec3 direction, const std::vector<Texture>& textures,
                              const Rgb& behind) const;
};

bool hasTexture(const Record& record);

/// The faces of an element that its texture covers, in the world; of a floor, its rectangle.
std::vector<TexturedFace> texturedFaces(const Element& element);

/// Reads textures, each file once.
class TextureReader {
  public:
    /// Index of the texture that the record names in `textures`. What is wrong with the file is a
    /// finding, and the index that of a white picture.
    std::uint32_t read(const Record& record, std::vector<Texture>& textures, Diagnostics& findings);

  private:
    [[nodiscard]] ColorPicture load(const std::string& file);

    std::map<std::string, std::uint32_t> known_;
    std::int64_t pixels_ = 0;
    ConfinedReader pictures_;
};

}  // namespace ispace
