// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of readers: their error messages, and robustness against damaged files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>

#include "base/error.h"

namespace ispace {

/// Returns the findings that `read` throws, one per line, or "no error".
template <typename Read>
std::string errorsOf(Read read) {
    try {
        read();
    } catch (const FormatError& error) {
        std::string all;
        for (const Diagnostic& diagnostic : error.diagnostics()) all += diagnostic.text() + '\n';
        return all;
    }
    return "no error";
}

/// Reads every truncation of a small file, then many copies with bytes changed, lines removed or
/// doubled: each must be read or rejected with a finding.
template <typename Read>
void surviveDamage(const std::string& good, Read read, int rounds = 1500) {
    const auto try_read = [&read](const std::string& bytes) {
        const std::string errors = errorsOf([&] { read(bytes); });
        EXPECT_NE(errors, "");
    };
    for (std::size_t i = 0; i < good.size(); ++i) try_read(good.substr(0, i));
    std::mt19937_64 random(good.size());
    for (int round = 0; round < rounds; ++round) {
        std::string bytes = good;
        for (auto n = 1 + random() % 4; n > 0; --n) {
            const std::size_t at = random() % bytes.size();
            constexpr std::string_view kTempting = "0123456789-+.e,\"[]{} \n\r\x00\xff";
            if (random() % 4 == 0) {
                const std::size_t line = bytes.rfind('\n', at) + 1;
                const std::size_t end = std::min(bytes.find('\n', at), bytes.size() - 1) + 1;
                if (random() % 2 == 0 && bytes.size() > end - line)
                    bytes.erase(line, end - line);
                else
                    bytes.insert(line, bytes.substr(line, end - line));
            } else {
                bytes[at] = random() % 2 == 0 ? kTempting[random() % kTempting.size()]
                                              : static_cast<char>(random());
            }
        }
        try_read(bytes);
    }
}

}  // namespace ispace
