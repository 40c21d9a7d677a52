// SPDX-License-Identifier: GPL-3.0-or-later
// The level of sound at a microphone, in dB of sound pressure (SPL). Deterministic, noise included,
// and thread-safe; O(speakers), each with rays for the walls between.
#pragma once

#include "extensions/microphones/microphone.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::microphones {

/// A reading of a microphone.
struct SoundLevel {
    double level = 0;  ///< sound pressure level, dB

    static const ReadingKind kKind;
};

/// Computes the level of all speakers together, as energies, and of the microphone's own noise.
/// A speaker is quieter by 20 lg(distance / 1 m), with a distance of at least 0.1 m, and by `loss`
/// for each wall between. Solid surfaces on the way that are less than half a metre behind the
/// first are one wall; people and robots are none.
SoundLevel readingOf(const Microphone& microphone, const Moment& now);

}  // namespace ispace::microphones
