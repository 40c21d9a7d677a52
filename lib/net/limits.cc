// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/limits.h"

#include <algorithm>

namespace ispace {

bool Ration::has(WallTime now) {
    if (now > filled_) {
        const double seconds = std::chrono::duration<double>(now - filled_).count();
        left_ = std::min(limits_.burst, left_ + limits_.rate * seconds);
        filled_ = now;
    }
    return left_ >= 1;
}

}  // namespace ispace
