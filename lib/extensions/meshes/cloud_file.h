// SPDX-License-Identifier: GPL-3.0-or-later
// Points of PCD, PLY and LAS files, one after another, without a copy of them.
//
// All sizes of a header are compared with the bytes before a point is read; a damaged file is a
// FormatError, never a read beyond its end. Binary points cost no memory of their own, packed ones
// that of the points. Equal bytes give equal points on every machine.
//
//     const CloudFile cloud(bytes, "hall.pcd");
//     cloud.forEach([&](const Point3& p) { box.add(p); });
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geom/point.h"

namespace ispace::meshes {

/// Returns true for PCD, LAS, and PLY without faces.
bool isPointCloud(std::string_view bytes);

/// The points of a file that isPointCloud(): PCD 0.7 (ascii, binary, binary_compressed), PLY 1.0
/// (ascii, either byte order, no lists before or among the vertices) and LAS 1.0 to 1.4.
/// Coordinates are those of the file, as doubles, unless setFrame() changes them. The bytes must
/// outlive it.
class CloudFile {
  public:
    /// Reads the header and decompresses the points if necessary. \param name for messages
    /// \throws FormatError: damaged, cut off, no x y z, compressed LAS (LAZ)
    CloudFile(std::string_view bytes, const std::string& name);

    /// Scales the points to metres and turns them upright. \param up the axis of the file that
    /// points up: x, y or z
    void setFrame(double metres_per_unit, char up) {
        metres_per_unit_ = metres_per_unit;
        up_ = up;
    }

    /// Calls visit(Point3) for each point but those with a coordinate that is not finite or no
    /// number. O(points)
    /// \throws FormatError with the line, for text
    template <typename Visit>
    void forEach(Visit visit) const {
        TextPlace at;
        for (std::size_t i = 0; i < count_; ++i)
            if (const std::optional<Point3> p = is_text_ ? textPoint(at) : point(i))
                visit(upright(*p));
    }

  private:
    /// Offset and format of a coordinate in binary points.
    struct Coordinate {
        char kind = 0;  ///< f, u or i, as its bytes are; 0: missing
        std::size_t size = 0, first = 0, step = 0;
        std::size_t column = 0;  ///< in text
        double scale = 1, offset = 0;
    };
    struct TextPlace {
        std::size_t byte = 0;
        int line = 0;
    };
    /// Turns a point as meshes are turned.
    [[nodiscard]] Point3 upright(const Point3& p) const {
        const double scale = metres_per_unit_;
        if (up_ == 'x') return {scale * p.y, scale * p.z, scale * p.x};
        if (up_ == 'y') return {scale * p.x, -scale * p.z, scale * p.y};
        return {scale * p.x, scale * p.y, scale * p.z};
    }
    [[noreturn]] void fail(const std::string& message, int line = 0) const;
    void readPcd();
    void readPly();
    void readLas();
    void unpackLzf(std::size_t unpacked_size);
    void checkCoordinates() const;
    [[nodiscard]] std::string_view headerLine();
    [[nodiscard]] double number(const Coordinate& of, std::size_t i) const;
    [[nodiscard]] std::optional<Point3> point(std::size_t i) const;
    std::optional<Point3> textPoint(TextPlace& at) const;

    const std::string& name_;
    std::string_view bytes_;  // the rest of the header, then the points
    std::string unpacked_;
    std::array<Coordinate, 3> xyz_;
    std::size_t count_ = 0;
    int line_ = 0;  // of the header
    bool is_text_ = false, is_big_endian_ = false;
    double metres_per_unit_ = 1;
    char up_ = 'z';
};

}  // namespace ispace::meshes
