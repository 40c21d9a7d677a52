// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs/poses: the proof of a bound over all poses as a file, and its check. The
// check uses geom and base, and of the search only Sector, PoseBox and FloorWeighting.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/proofs/poses/outer_bound.h"
#include "geom/polygon.h"

namespace ispace::proofs {

/// The area that a proof bounds.
struct PoseGoal {
    int times = 1;  ///< floor counts if this many sensors see it
    poses::FloorWeighting weights = {};
};

/// The proof of boundOverPoses() that equal sensors see at most `bound`. Each tree is a character
/// for each node, in pre-order: a node that is split, its first half, its second half. It does not
/// hold the room, the sensors and the goal: a check that is given others proves another bound.
struct PoseCertificate {
    double bound = 0;  ///< m2, by weight
    /// All poses: a box is halved along `x`, along `y` or in its headings (`h`), or whole (`.`).
    std::string boxes;
    /// Tuples of boxes, one for each sensor: box `0` to `3` of the tuple is halved; a tuple is
    /// bounded as a whole (`.`) or left out (`-`), as its poses are out of the order of the tree of
    /// boxes or one of them sees no floor.
    std::string tuples;
};

/// Writes a certificate, with the history of the layout.
std::string certificateText(const PoseCertificate& certificate,
                            const std::vector<std::string>& history);

/// \throws FormatError
PoseCertificate readCertificate(std::string_view text, const std::string& name);

struct CertificateCheck {
    /// No poses of the sensors see more, m2; or else the bound of the tuple `refused`.
    double bound = 0;
    /// The first tuple of the tree, from 1, that may see more than the certificate states (but for
    /// rounding); 0: none. Later ones need not be bounded.
    std::size_t refused = 0;
    std::size_t bounded = 0;  ///< tuples; with one that is refused, it depends on the threads
    std::size_t boxes = 0, tuples = 0;  ///< of the trees
    double floor = 0;                   ///< m2, by weight, rounded up
};

/// Computes the bound that the trees of a certificate prove, all views anew by BoxViews: in cells
/// of the size of the search, but finer parts, so that it does not exceed that of the search but by
/// rounding.
/// \param most number of cells, as for PoseFloor \param name of the certificate, for errors
/// \throws FormatError for trees that leave out poses \pre 1 <= goal.times <= sensors
CertificateCheck checkCertificate(std::span<const Region> floor, std::size_t most,
                                  const poses::Sector& sector, int sensors, const PoseGoal& goal,
                                  const PoseCertificate& certificate, const std::string& name);

}  // namespace ispace::proofs
