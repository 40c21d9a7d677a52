// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/parts.h"

#include <algorithm>
#include <limits>

#include "env/mesh_cut.h"
#include "geom/polygon.h"

namespace ispace {

Parts::Parts(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    first_.reserve(elements.size() + 1);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        first_.push_back(parts_.size());
        for (const Prism& prism : elements[i].body.prisms) add(i, prism);
        for (const Sheet& sheet : elements[i].body.sheets)
            parts_.push_back({i, {sheet.line.a, sheet.line.b}, sheet.bottom, sheet.top});
    }
    first_.push_back(parts_.size());
    std::vector<Box2> boxes;
    boxes.reserve(parts_.size());
    for (const Part& part : parts_) boxes.push_back(bounds(part.footprint));
    tree_ = BoxTree(boxes);
}

void Parts::add(std::size_t element, const Prism& prism) {
    if (isConvex(prism.footprint)) {
        parts_.push_back({element, prism.footprint, prism.bottom, prism.top});
        return;
    }
    const Triangulation pieces = triangulate({prism.footprint, {}});
    for (const auto& [i, j, k] : pieces.triangles)
        parts_.push_back({element,
                          {pieces.vertices[i], pieces.vertices[j], pieces.vertices[k]},
                          prism.bottom,
                          prism.top});
}

std::span<const Part> Parts::of(std::size_t element) const {
    return {parts_.data() + first_[element], first_[element + 1] - first_[element]};
}

MeshCuts::MeshCuts(const Body& body) : body_(&body) {
    heights_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Mesh& mesh : body.meshes)
        for (const Point3& p : mesh.vertices) {
            box_.add(p.onFloor());
            heights_.bottom = std::min(heights_.bottom, p.z);
            heights_.top = std::max(heights_.top, p.z);
        }
}

const Slice& MeshCuts::at(double height) {
    constexpr std::size_t kKept = 256;
    if (cuts_.size() >= kKept && !cuts_.contains(height)) cuts_.clear();
    const auto [place, is_new] = cuts_.try_emplace(height);
    if (is_new) cutMeshes(*body_, height, place->second);
    return place->second;
}

std::vector<double> MeshCuts::heightsIn(const HeightRange& heights) const {
    constexpr int kLevels = 32, kMost = 5;
    std::vector<double> levels;
    for (int i = 0; i < kLevels; ++i) {
        const double height =
            heights_.bottom + (heights_.top - heights_.bottom) * (i + 0.5) / kLevels;
        if (height > heights.bottom && height < heights.top) levels.push_back(height);
    }
    if (levels.empty()) return {heights.bottom + (heights.top - heights.bottom) / 2};
    std::vector<double> some;
    const std::size_t count = std::min<std::size_t>(levels.size(), kMost);
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(levels[i * (levels.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
    return some;
}

}  // namespace ispace
