// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs: the check of proofs of guards. It uses geom and base, and the triangles
// and half-planes of its poses, but no code of the search in its gallery.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "extensions/proofs/gallery/guard_certificate.h"

namespace ispace::proofs {

struct GuardCheck {
    /// No fewer points see the floor; valid whatever the weights are. 0 for trees that prove less
    /// than the certificate states, which are checked no further.
    std::size_t bound = 0;
    double missed = 0;  ///< floor that the guards leave unseen, m2
    double area = 0;    ///< of the floor, m2
    std::size_t trees = 0, leaves = 0;
    std::size_t cells = 0;  ///< convex parts of the floor of which the witnesses were counted
};

/// Computes the number of guards that a certificate proves, and the floor that the guards leave
/// unseen.
///
/// Sight goes from triangle to triangle of the floor, through a cone that the ends of edges bound.
/// The floor is cut along cones of witnesses, a little outside of them, until the witnesses with
/// cones in a part have no more weight than a point may see, and are of one tree. Sight along
/// lines alone, through a corner at which walls touch, does not count: such guards would leave
/// floor around the witness unseen, which others see then, and with it the witness. \param name of
/// the certificate, for errors \throws FormatError for witnesses off the floor, for views of too
/// many cones, and for leaves that cut the floor into too many parts
GuardCheck checkGuards(std::span<const Region> floor, std::span<const Point2> guards,
                       const GuardCertificate& certificate, const std::string& name);

}  // namespace ispace::proofs
