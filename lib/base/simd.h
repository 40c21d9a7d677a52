// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>  // defines __GLIBC__ where it is

/// Before a function: it is compiled for several generations of the processor, and the program
/// takes the fastest that runs here. Loops in it must be plain enough for the compiler to
/// vectorise; what it calls must be inlined (ISPACE_INLINE) to profit. Results do not depend on the
/// choice, as operations of IEEE arithmetic are the same in vectors of any width and none are
/// contracted.
///
/// Nothing where resolvers do not work (other processors and C libraries, Clang, sanitizers) or the
/// compiler does not know those generations (GCC before 12).
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    __GNUC__ >= 12 && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ISPACE_SIMD_CLONES \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define ISPACE_SIMD_CLONES
#endif

/// Inlined into its callers whatever the compiler thinks.
#define ISPACE_INLINE [[gnu::always_inline]] inline
