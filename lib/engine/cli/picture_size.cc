// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture_size.h"

#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

PictureSize pictureSize(const std::string& text) {
    constexpr std::int64_t kMinPixels = 16, kMaxPixels = 16384;
    const auto side = [&](const std::string& word) {
        const std::optional<std::int64_t> pixels = parseInteger(word);
        if (!pixels || *pixels < kMinPixels || *pixels > kMaxPixels)
            throw UsageError("`" + text + "`: wanted W or W,H, each from " +
                             std::to_string(kMinPixels) + " to " + std::to_string(kMaxPixels) +
                             " pixels");
        return static_cast<int>(*pixels);
    };
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) return {side(text), 0};
    return {side(text.substr(0, comma)), side(text.substr(comma + 1))};
}

}  // namespace ispace
