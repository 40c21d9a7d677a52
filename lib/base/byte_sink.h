// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>

namespace ispace {

/// Takes bytes as they come, in order.
using ByteSink = std::function<void(std::string_view)>;

/// Appends the bytes of a number as binary formats have it, little-endian.
template <typename Number>
void appendLittle(std::string& out, Number value) {
    static_assert(std::is_arithmetic_v<Number> && std::endian::native == std::endian::little);
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace ispace
