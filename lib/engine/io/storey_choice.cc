// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/storey_choice.h"

#include "base/glob.h"
#include "io/plan/layer_names.h"

namespace ispace {

bool StoreyChoice::isAll(const std::string& word) { return lowerCased(word) == "all"; }

bool StoreyChoice::isOne() const {
    return words.size() == 1 && !words.front().empty() && !isAll(words.front()) &&
           !Glob(words.front()).isPattern();
}

}  // namespace ispace
