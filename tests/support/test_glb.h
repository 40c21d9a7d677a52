// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of compiled files: round trips, and errors of damaged ones.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

#include "base/error.h"
#include "io/glb/glb_read.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"

namespace ispace::testing {

inline std::string compiled(const Document& document) {
    return writeGlb(makeScene(document, nullptr, DeviceCatalogue()), document);
}

inline Document readCompiled(std::string_view bytes) {
    return readGlb(bytes, "room.glb", sceneSchemas());
}

/// Returns the message that reading throws, or "no error".
inline std::string errorOf(std::string_view bytes) {
    try {
        readCompiled(bytes);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

/// Flips bits in the first `front` bytes of a file, in many ways; reading must never crash. Some
/// flips are harmless (a mesh's name), so some copies must be read and some rejected.
inline void surviveFlips(const std::string& glb, std::size_t front, std::uint64_t seed) {
    constexpr int kPaths = 20000;
    std::mt19937_64 random(seed);
    int refused = 0;
    for (int i = 0; i < kPaths; ++i) {
        std::string bytes = glb;
        for (std::size_t flips = 1 + random() % 3; flips > 0; --flips)
            bytes[random() % front] ^= static_cast<char>(1U << (random() % 8));
        if (errorOf(bytes) != "no error") ++refused;
    }
    EXPECT_GT(refused, kPaths / 20);
    EXPECT_LT(refused, kPaths);
}

}  // namespace ispace::testing
