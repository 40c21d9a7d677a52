// SPDX-License-Identifier: GPL-3.0-or-later
// Small types of ARIA: integers by their size, ends of lists, and the word before exported classes.
#ifndef SIM_ARIA_TYPEDEFS_H
#define SIM_ARIA_TYPEDEFS_H

#include <cstdint>

/// Programs mark their own classes with it.
#ifndef AREXPORT
#define AREXPORT
#endif

/// Integers of a robot's packets.
class ArTypes {
  public:
    using Byte = std::int8_t;
    using Byte2 = std::int16_t;
    using Byte4 = std::int32_t;
    using UByte = std::uint8_t;
    using UByte2 = std::uint16_t;
    using UByte4 = std::uint32_t;
};

/// End of a list of callbacks.
class ArListPos {
  public:
    enum Pos { FIRST = 1, LAST = 2 };
};

/// Importance of a parameter in a configuration.
class ArPriority {
  public:
    enum Priority {
        IMPORTANT,
        NORMAL,
        DETAILED,
        TRIVIAL,
        EXPERT,
        FACTORY,
        CALIBRATION,
        BASIC = IMPORTANT,
        INTERMEDIATE = NORMAL,
        ADVANCED = DETAILED
    };
};

#endif  // SIM_ARIA_TYPEDEFS_H
