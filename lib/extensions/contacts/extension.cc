// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/contacts/contact.h"

namespace ispace::extension {

Extension contacts() { return {.name = "contacts", .add = contacts::addContacts}; }

}  // namespace ispace::extension
