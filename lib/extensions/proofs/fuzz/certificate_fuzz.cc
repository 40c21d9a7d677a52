// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of bounds over all poses, as `arrange --verify` reads them. Whatever the trees are,
// a check that does not refuse them proves a bound that no layout exceeds.
#include "extensions/proofs/poses/certificate.h"

#include <algorithm>
#include <array>
#include <vector>

#include "fuzz.h"
#include "geom/arrangement.h"
#include "geom/visibility/visibility.h"

namespace {

using namespace ispace;

constexpr std::size_t kCells = 150;
const proofs::poses::Sector kSector{2.5, 2, 0};
const Region kRoom{{{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 6}, {0, 6}}, {}};

/// Area that two lasers in the arms of the room see, or one of them; chords lie within the views.
double areaOfLayout(bool is_one = false) {
    std::vector<Segment2> walls;
    kRoom.forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
    const VisibilityMap map(walls);
    std::vector<Polygon> views;
    for (const auto& [at, heading] :
         std::array{std::pair(Point2{0.5, 2.5}, 20.0), std::pair(Point2{3.5, 0.1}, 30.0)}) {
        Polygon view = {at};
        for (const VisibilityEdge& edge :
             sectorOf(map.query(at, kSector.range), Angle::degrees(heading),
                      Angle::radians(kSector.field))
                 .edges) {
            view.push_back(edge.from);
            view.push_back(edge.to);
        }
        views.push_back(std::move(view));
        if (is_one) break;
    }
    return totalArea(unite(views));
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    constexpr double kRounding = 1e-6;
    static const double known = areaOfLayout();
    const proofs::PoseCertificate read = proofs::readCertificate(bytes, "c");
    const std::string text = proofs::certificateText(read, {"arrange"});
    const proofs::PoseCertificate again =
        readBack([&] { return proofs::readCertificate(text, "c"); });
    require(proofs::certificateText(again, {"arrange"}) == text,
            "another certificate after writing it");
    // No trees prove less than a layout sees.
    const auto refuses = [&read](const proofs::PoseGoal& goal, double area) {
        proofs::PoseCertificate low = read;
        low.bound = std::min(read.bound, area - 2 * kRounding);
        const proofs::CertificateCheck check =
            proofs::checkCertificate({&kRoom, 1}, kCells, kSector, 2, goal, low, "c");
        require(check.boxes == read.boxes.size(), "boxes were not read");
        return check.refused != 0 && check.bound > low.bound;
    };
    require(refuses({}, known), "a bound below a layout");
    // One pose twice, and the same by weight.
    static const double twice = areaOfLayout(true);
    require(refuses({.times = 2}, twice), "a bound below a layout, twice");
    const proofs::PoseGoal doubled{
        2, {.elsewhere = 0, .pieces = {{{{0, 0}, {6, 0}, {6, 6}, {0, 6}}, 2}}}};
    require(refuses(doubled, 2 * twice), "a bound below a layout by weight");
}
