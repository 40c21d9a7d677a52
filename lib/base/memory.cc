// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"

#include <limits>  // defines __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace ispace {

void keepFreedMemory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace ispace
