// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of proofs over poses: floors.
#pragma once

#include "geom/polygon.h"

namespace ispace {

/// Two rooms with a door of 1 m between them, and a pillar in the second.
inline Region roomsWithPillar() {
    return {{{0, 0},
             {6, 0},
             {6, 2},
             {6.2, 2},
             {6.2, 0},
             {11, 0},
             {11, 5},
             {6.2, 5},
             {6.2, 3},
             {6, 3},
             {6, 5},
             {0, 5}},
            {{{8, 2}, {8, 3}, {9, 3}, {9, 2}}}};
}

}  // namespace ispace
