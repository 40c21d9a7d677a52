// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"

#include <cstdint>
#include <filesystem>
#include <limits>  // defines __GLIBC__
#include <system_error>

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

void keepFreedMemory(const std::vector<std::string>& inputs) {
    constexpr std::uintmax_t kLarge = 1 << 18;
    std::uintmax_t bytes = 0;
    for (const std::string& input : inputs) {
        std::error_code error;
        if (const auto size = std::filesystem::file_size(input, error); !error) bytes += size;
    }
    if (bytes >= kLarge) keepFreedMemory();
}

void returnFreedMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace ispace
