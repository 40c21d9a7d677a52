// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/days/person_verbs.h"

#include <utility>

namespace ispace::days {

namespace {

std::vector<PersonVerb>& verbs() {
    static std::vector<PersonVerb> known;
    return known;
}

}  // namespace

void addPersonVerb(PersonVerb verb) { verbs().push_back(std::move(verb)); }

const std::vector<PersonVerb>& personVerbs() { return verbs(); }

}  // namespace ispace::days
