// SPDX-License-Identifier: GPL-3.0-or-later
// A program that holds this file's object ends with status 1 and one line, and not by an abort,
// where memory or a thread is refused and nobody can catch an exception: in libraries' threads, in
// functions that must not throw, and before main(). Without such a reason it stays an abort, which
// is a mistake in the program.
#pragma once

#include <initializer_list>
#include <string_view>

namespace ispace {

/// Writes the pieces and a newline to stderr. Needs no memory, and waits where stderr is
/// non-blocking. May be called at any time, also before main().
void sayLine(std::initializer_list<std::string_view> pieces) noexcept;

/// What is said where memory ran out, once: libraries may find it out again at the end. Needs none.
void sayMemoryIsOut(std::string_view tool) noexcept;

}  // namespace ispace
