// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "env/walls.h"
#include "geom/tolerance.h"

namespace ispace {

namespace {

/// Maximum pixels of all textures of a scene.
constexpr std::int64_t kMaxTexturePixels = 120'000'000;

/// From sRGB.
const std::array<float, 256>& linearOf() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double x = static_cast<double>(i) / 255;
            values[i] =
                static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
        }
        return values;
    }();
    return table;
}

/// The two pixels around a position, and its distance from the first.
struct Between {
    std::size_t low = 0, high = 0;
    float share = 0;

    Between(double place, int count) {
        const double at = std::clamp(place * count - 0.5, 0.0, count - 1.0);
        low = static_cast<std::size_t>(at);
        high = std::min(low + 1, static_cast<std::size_t>(count) - 1);
        share = static_cast<float>(at - std::floor(at));
    }
};

}  // namespace

Rgb Texture::at(double u, double v, const Rgb& behind) const {
    const Between x(u, picture_.width), y(v, picture_.height);
    const std::array<float, 256>& linear = linearOf();
    const auto width = static_cast<std::size_t>(picture_.width);
    Rgb out{};
    for (const auto& [row, down] : {std::pair(y.low, 1 - y.share), std::pair(y.high, y.share)})
        for (const auto& [column, along] :
             {std::pair(x.low, 1 - x.share), std::pair(x.high, x.share)}) {
            const std::uint8_t* const pixel = &picture_.rgba[4 * (row * width + column)];
            const float opacity = static_cast<float>(pixel[3]) / 255, weight = down * along;
            for (std::size_t k = 0; k < 3; ++k)
                out[k] +=
                    weight * (behind[k] + opacity * (linear[std::size_t{pixel[k]}] - behind[k]));
        }
    return out;
}

bool TexturedFace::holds(const Point3& a, const Point3& b, const Point3& c) const {
    const Vec3 across = cross(b - a, c - a), normal = cross(right, down);
    const double size = length(across) * length(normal);
    if (!(size > 0) || std::fabs(dot(across, normal)) < (1 - 1e-6) * size) return false;
    Vec3 middle{};
    for (const Point3* p : {&a, &b, &c}) {
        const Vec3 way = *p - corner;
        middle = {middle.x + way.x / 3, middle.y + way.y / 3, middle.z + way.z / 3};
    }
    const double u = dot(middle, right) / dot(right, right);
    const double v = dot(middle, down) / dot(down, down);
    constexpr double kSlack = 1e-3;
    return std::fabs(dot(middle, normal)) <= reach * length(normal) && u >= -kSlack &&
           u <= 1 + kSlack && v >= -kSlack && v <= 1 + kSlack;
}

Rgb TexturedFace::colorAt(Point3 place, Vec3 direction, const std::vector<Texture>& textures,
                          const Rgb& behind) const {
    const Vec3 way = place - corner;
    const double u = dot(way, right) / dot(right, right);
    const bool is_front = dot(cross(right, down), direction) >= 0;
    return textures[texture].at(is_front ? u : 1 - u, dot(way, down) / dot(down, down), behind);
}

namespace {

/// The sides of an upright box, seen from outside; every second, or all.
void addSides(const Prism& prism, std::size_t step, std::vector<TexturedFace>& faces) {
    const Polygon& p = prism.footprint;
    for (std::size_t i = 0; i < p.size(); i += step) {
        const Vec2 along = p[(i + 1) % p.size()] - p[i];
        faces.push_back({{p[i].x, p[i].y, prism.top},
                         {along.x, along.y, 0},
                         {0, 0, prism.bottom - prism.top},
                         kCornerTolerance});
    }
}

/// A level rectangle given counter-clockwise from its lower left corner, seen from above.
TexturedFace levelFace(Point2 low_left, Vec2 along, Vec2 across, double z) {
    const Point2 corner = low_left + across;
    return {{corner.x, corner.y, z},
            {along.x, along.y, 0},
            {-across.x, -across.y, 0},
            kCornerTolerance};
}

std::vector<TexturedFace> wallFaces(const Record& record) {
    std::vector<TexturedFace> faces;
    Diagnostics ignored;  // reported when the environment is built
    for (const WallLine& wall : wallLinesOf(record, ignored)) {
        const auto& [a, b] = wall.line;
        faces.push_back({{a.x, a.y, wall.top},
                         {b.x - a.x, b.y - a.y, 0},
                         {0, 0, wall.bottom - wall.top},
                         wall.thickness / 2 + kCornerTolerance});
    }
    return faces;
}

}  // namespace

std::vector<TexturedFace> texturedFaces(const Element& element) {
    if (isWall(element.record)) return wallFaces(element.record);
    const std::string& keyword = element.record.keyword();
    const Body& body = element.body;
    std::vector<TexturedFace> faces;
    for (const Prism& prism : body.prisms) {
        if (prism.footprint.size() != 4) continue;
        const Polygon& p = prism.footprint;
        if (keyword == "cube") {
            addSides(prism, 1, faces);
            faces.push_back(levelFace(p[0], p[1] - p[0], p[3] - p[0], prism.top));
        } else if (keyword == "barrier" || prism.material == Material::Screen) {
            addSides(prism, 2, faces);
        }
    }
    if (keyword == "floor" && !body.plates.empty()) {
        // Its squares come row by row.
        const Polygon &first = body.plates.front().outline, &last = body.plates.back().outline;
        const Vec2 whole = last[2] - first[0];
        const Vec2 along = first[1] - first[0], across = first[3] - first[0];
        faces.push_back(levelFace(first[0], dot(whole, along) / dot(along, along) * along,
                                  dot(whole, across) / dot(across, across) * across,
                                  body.plates.front().z));
    }
    return faces;
}

ColorPicture TextureReader::load(const std::string& file) {
    if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
        if (error) throw std::system_error(error);
        throw FormatError(Diagnostic{displayName(file), 0, 0, "not a regular file"});
    }
    ColorPicture picture = parseColorPicture(readAll(file), file, pictures_);
    pixels_ += std::int64_t{picture.width} * picture.height;
    if (pixels_ > kMaxTexturePixels)
        throw FormatError(Diagnostic{displayName(file), 0, 0,
                                     "the textures together have more than " +
                                         std::to_string(kMaxTexturePixels) + " pixels"});
    return picture;
}

std::uint32_t TextureReader::read(const Record& record, std::vector<Texture>& textures,
                                  Diagnostics& findings) {
    const std::string& file = record.text("texture");
    const auto [known, is_new] = known_.emplace(file, static_cast<std::uint32_t>(textures.size()));
    if (!is_new) return known->second;
    const auto fail = [&](const std::string& what) {
        findings.add(record.finding("texture", "texture `" + printable(file) + '`' + what));
        textures.emplace_back(ColorPicture{1, 1, {255, 255, 255, 255}});
    };
    try {
        textures.emplace_back(load(file));
    } catch (const std::system_error& error) {
        fail(" cannot be opened: " + error.code().message());
    } catch (const FormatError& error) {
        fail(": " + error.diagnostics().front().message);
    }
    return known->second;
}

bool hasTexture(const Record& record) {
    return record.schema().find("texture") != nullptr && record.has("texture");
}

std::vector<std::string> textureFiles(const Scene& scene) {
    std::vector<std::string> files;
    for (const Record& record : scene.records)
        if (hasTexture(record) &&
            std::find(files.begin(), files.end(), record.text("texture")) == files.end())
            files.push_back(record.text("texture"));
    return files;
}

}  // namespace ispace
