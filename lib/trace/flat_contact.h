// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trace/flat_tree.h"

namespace ispace {

/// True if the straight continuation of a line may pass within `contact` of the origin: then ask
/// continuesContact().
inline bool mayContinueContact(double height, double contact) {
    // Distances of lines and of their continuations round differently.
    return height < contact * (1 + 1e-9);
}

/// True if some line nearer to the origin than `contact` has the direction of line i of the leaf.
bool continuesContact(const FlatTree& tree, const FlatTree::Leaf& leaf, int i, double ox, double oy,
                      double contact);

}  // namespace ispace
