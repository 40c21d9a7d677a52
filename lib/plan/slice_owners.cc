// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/slice_owners.h"

#include <algorithm>
#include <utility>

namespace ispace {

namespace {

/// For each of `wanted` the owner of an equal one among `known`. O(n log n).
template <typename Part, typename Less>
std::vector<std::size_t> match(const std::vector<Part>& wanted, const std::vector<Part>& known,
                               const std::vector<std::size_t>& owners, std::size_t nobody,
                               Less less) {
    std::vector<std::size_t> order(known.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return less(known[a], known[b]); });
    std::vector<std::size_t> result;
    result.reserve(wanted.size());
    for (const Part& part : wanted) {
        const auto at =
            std::lower_bound(order.begin(), order.end(), part,
                             [&](std::size_t i, const Part& p) { return less(known[i], p); });
        const bool found = at != order.end() && !less(part, known[*at]);
        result.push_back(found && *at < owners.size() ? owners[*at] : nobody);
    }
    return result;
}

}  // namespace

std::vector<Polygon> inscribedSolids(const Slice& slice) {
    std::vector<Polygon> solids = slice.solids;
    for (const Slice::Round& round : slice.rounds) solids[round.solid] = inscribedIn(round.curve);
    return solids;
}

SliceOwners ownersOf(const Environment& environment, const Slice& slice) {
    const Band band = environment.band(slice.height, slice.height);
    const std::size_t nobody = environment.elements().size();
    const auto line_less = [](const Segment2& a, const Segment2& b) {
        return a.a == b.a ? lexLess(a.b, b.b) : lexLess(a.a, b.a);
    };
    const auto polygon_less = [](const Polygon& a, const Polygon& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lexLess);
    };
    return {match(slice.sheets, band.sheets, band.sheet_owners, nobody, line_less),
            match(inscribedSolids(slice), band.solids, band.solid_owners, nobody, polygon_less)};
}

}  // namespace ispace
