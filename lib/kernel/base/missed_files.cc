// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/missed_files.h"

namespace ispace {

namespace {

thread_local MissedFiles* innermost = nullptr;

}  // namespace

MissedFiles::MissedFiles() : outer_(innermost) { innermost = this; }

MissedFiles::~MissedFiles() { innermost = outer_; }

void noteMissed(const std::string& name) {
    for (MissedFiles* scope = innermost; scope != nullptr; scope = scope->outer_)
        scope->names_.insert(name);
}

}  // namespace ispace
