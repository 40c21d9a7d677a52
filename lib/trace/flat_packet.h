// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trace/flat_tree.h"

namespace ispace {

/// Rays with an origin each, and what they have met so far.
struct alignas(64) FlatPacket {
    static constexpr int kBlock = 8;  ///< rays drawn to at once
    static constexpr int kMost = 64;
    /// Fewer are quicker alone.
    static constexpr int kLeast = 3;

    double x[kMost], y[kMost];  ///< unit vectors, as the ranges shall be for
    double origin_x[kMost], origin_y[kMost];
    double nearness[kMost];  ///< one over the range
    double cosine[kMost];    ///< only if wanted
    int count;               ///< a multiple of kBlock, not 0; rays may be repeated to get there
};

/// How far origins may lie apart for a packet to be quicker than rays alone.
double widestPacket(const FlatTree& tree);

struct FlatPacketLimits {
    double contact;
    double least_nearness;
    double widest;
};

/// Draws all lines into the packet, front to back. Its rays meet what they would alone, if that is
/// nearer than least_nearness. False if it is too wide for that to be quick, or not of finite
/// numbers; then nothing is done.
bool drawLines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet);
/// The same with cosines: the largest among lines met at the same place.
bool drawLinesAndCosines(const FlatTree& tree, const FlatPacketLimits& limits, FlatPacket& packet);

}  // namespace ispace
