// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

namespace ispace {

/// Moves a value to where it stays until the process ends and is never destroyed: to free all that
/// is known of a large room takes long. For main functions, once for each type: a second value
/// would be a leak. (`used`: a compiler may leave out a pointer that nobody reads, and then the
/// first is one, too.)
template <typename T>
const T& leftToExit(T value) {
    [[gnu::used]] static const T* pointer = nullptr;
    pointer = new T(std::move(value));
    return *pointer;
}

}  // namespace ispace
