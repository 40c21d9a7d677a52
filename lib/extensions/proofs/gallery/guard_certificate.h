// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs/gallery: the proof that a floor needs so many guards, as a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/polygon.h"

namespace ispace::proofs {

struct GalleryCover;

/// The proof that fewer points than `bound` do not see all witnesses.
///
/// Each tree proves a number of points. No point sees witnesses of two trees, so numbers add up.
///
/// A leaf gives weights to its rows: if no point sees rows of more than kUnit together, a sum above
/// (n - 1) kUnit takes n points. Rows are the witnesses and, after them, the pairs of nodes above
/// of which a point sees both witnesses.
struct GuardCertificate {
    static constexpr std::int64_t kUnit = 1'000'000'000;
    struct Node {
        bool is_leaf = true;
        /// Else: in its first subtree some guard sees both of these witnesses, in its second none.
        std::array<std::uint32_t, 2> pair{};
        std::vector<std::pair<std::uint32_t, std::int64_t>> weights;  ///< of a leaf, by row
    };
    std::size_t bound = 0;
    std::vector<Point2> witnesses;   ///< metres
    using Tree = std::vector<Node>;  ///< in pre-order
    std::vector<Tree> trees;
};

/// Proves the bound of a cover, or a smaller one if that takes too many nodes, from its sets of
/// witnesses: by linear programs, with solutions rounded down.
GuardCertificate certifyGuards(const GalleryCover& cover);

/// Writes a certificate, with the history of the layout.
std::string certificateText(const GuardCertificate& certificate,
                            const std::vector<std::string>& history);

/// Returns the warning for a certificate of fewer points than are known to be needed; empty if it
/// proves as many.
std::string weaknessOf(const GuardCertificate& certificate, std::size_t needed);

/// True for the text of a GuardCertificate, false for that of a PoseCertificate.
bool isOfGuards(std::string_view certificate);

/// \throws FormatError
GuardCertificate readGuardCertificate(std::string_view text, const std::string& name);

}  // namespace ispace::proofs
