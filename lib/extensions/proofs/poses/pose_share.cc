// SPDX-License-Identifier: GPL-3.0-or-later
// Results of shards. Each names its search by a fingerprint, and the tuples that were dealt out by
// another: parts of different searches, or shares of different tuples, never join.
#include "extensions/proofs/poses/pose_share.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"

namespace ispace::proofs::poses {

namespace {

std::string proofName(int shard) { return "poses/" + std::to_string(shard); }

double finiteFrom(Unpacker& from) {
    const auto number = std::bit_cast<double>(from.number());
    if (!std::isfinite(number)) Unpacker::refuse();
    return number;
}

}  // namespace

void pack(Packer& to, double number) { to.add(std::bit_cast<std::uint64_t>(number)); }

void pack(Packer& to, const PosedLayout& layout) {
    pack(to, layout.area);
    to.add(layout.poses.size());
    for (const Pose2& pose : layout.poses)
        for (const double number : {pose.position.x, pose.position.y, pose.heading.degrees()})
            pack(to, number);
}

double unpackArea(Unpacker& from) {
    const double area = finiteFrom(from);
    if (area < 0) Unpacker::refuse();
    return area;
}

PosedLayout unpackLayout(Unpacker& from, int sensors) {
    PosedLayout layout{unpackArea(from)};
    const std::uint64_t count = from.number();
    if (count != 0 && count != static_cast<std::uint64_t>(sensors)) Unpacker::refuse();
    for (std::uint64_t i = 0; i < count; ++i) {
        const double x = finiteFrom(from), y = finiteFrom(from);
        layout.poses.push_back({{x, y}, Angle::degrees(finiteFrom(from))});
    }
    return layout;
}

std::uint64_t markOf(const PoseFloor& floor, const Sector& sector,
                     const PoseSearchOptions& options) {
    constexpr std::uint64_t kForm = 4;  // version of the bytes
    Packer to;
    to.add(kForm);
    for (std::size_t i = 0; i < floor.triangles().size(); ++i)
        for (const Point2 p : floor.cornersOf(i)) {
            pack(to, p.x);
            pack(to, p.y);
        }
    to.addAll(floor.parts());
    pack(to, floor.weightOf([](std::size_t first, std::size_t count) { return first + count; }));
    for (const double number :
         {floor.mostWeight(), sector.range, sector.field, sector.first, sector.near, options.gap})
        pack(to, number);
    for (const int number : {options.sensors, options.times})
        to.add(static_cast<std::uint64_t>(number));
    return hashOf(to.bytes());
}

void storeProof(const PoseShare& share, std::uint64_t mark, std::uint64_t dealt,
                const PoseBound& proof) {
    Packer to;
    to.add(mark);
    to.add(dealt);
    pack(to, proof.bound);
    pack(to, proof.found);
    for (const std::uint64_t number :
         {proof.boxes, proof.tuples, std::size_t{proof.is_complete ? 1U : 0U}})
        to.add(number);
    share.results->store(proofName(share.own->index), to.bytes());
}

PoseBound joinedProof(const PoseShare& share, std::uint64_t mark, int sensors, double found) {
    PoseBound all{.bound = found, .found = {found}};
    std::uint64_t all_dealt = 0;
    for (int i = 1; i <= share.joined; ++i) {
        const auto bytes = share.results->find(proofName(i));
        if (!bytes) Unpacker::refuse();
        Unpacker from(*bytes);
        if (from.number() != mark) Unpacker::refuse();
        // A shard that was done, or cut short, before it dealt bounds all tuples.
        const std::uint64_t dealt = from.number();
        if (dealt != 0 && all_dealt != 0 && dealt != all_dealt)
            throw FormatError({share.results->file(), 0, 0,
                               "shard " + std::to_string(i) +
                                   " searched a share of other tuples than those before it"});
        if (dealt != 0) all_dealt = dealt;
        const double bound = unpackArea(from);
        PosedLayout layout = unpackLayout(from, sensors);
        if (layout.area > bound) Unpacker::refuse();
        all.bound = std::max(all.bound, bound);
        if (layout.area > all.found.area) all.found = std::move(layout);
        all.boxes += from.number();
        all.tuples += from.number();
        if (from.number() != 1) all.is_complete = false;
        if (!from.atEnd()) Unpacker::refuse();
    }
    return all;
}

}  // namespace ispace::proofs::poses
