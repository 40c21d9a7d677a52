// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: results of a search over poses as bytes, for shards and later
// runs.
#pragma once

#include <cstdint>

#include "base/packed.h"
#include "extensions/proofs/poses/pose_search.h"

namespace ispace::proofs::poses {

/// Computes a fingerprint of the floor, the sensors and the options that decide the proof.
std::uint64_t markOf(const PoseFloor& floor, const Sector& sector,
                     const PoseSearchOptions& options);

void pack(Packer& to, double number);
void pack(Packer& to, const PosedLayout& layout);
/// \throws FormatError unless it is finite and not negative
double unpackArea(Unpacker& from);
/// \throws FormatError unless it has no poses or one for each sensor
PosedLayout unpackLayout(Unpacker& from, int sensors);

/// Stores the proof of a shard.
/// \param dealt fingerprint of the tuples that shards dealt out; 0: it searched all of them
void storeProof(const PoseShare& share, std::uint64_t mark, std::uint64_t dealt,
                const PoseBound& proof);
/// Merges the proofs of all shards: the best layout, also than the area `found` that was known
/// before, and the highest bound. \throws FormatError if one is missing, damaged, of another search
/// or a share of other tuples
PoseBound joinedProof(const PoseShare& share, std::uint64_t mark, int sensors, double found);

}  // namespace ispace::proofs::poses
