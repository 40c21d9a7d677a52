// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the kind to a program of tests, as the tools do.
#pragma once

#include "extensions/contacts/contact.h"

namespace ispace::testing {

inline const bool kAddedContacts = [] {
    contacts::addContacts();
    return true;
}();

}  // namespace ispace::testing
