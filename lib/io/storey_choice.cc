// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/storey_choice.h"

#include "base/glob.h"

namespace ispace {

bool StoreyChoice::isOne() const {
    return words.size() == 1 && words.front() != kAllStoreys && !Glob(words.front()).isPattern();
}

}  // namespace ispace
