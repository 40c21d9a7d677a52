// SPDX-License-Identifier: GPL-3.0-or-later
// Records the files that readers looked for and did not find. Programs that cache a result, or wait
// for changes of its inputs, need their names: the result changes once such a file appears.
//
//     const MissedFiles missed;
//     const Document room = read("world.sdf");
//     watch(missed.names());
#pragma once

#include <set>
#include <string>

namespace ispace {

/// The files that readers of this thread look for in vain while this lives: if one appears later,
/// they may read it instead of another. Scopes may nest; a name belongs to all of them. Each thread
/// has its scopes: readers that start threads lose the names that those look for.
class MissedFiles {
  public:
    MissedFiles();
    ~MissedFiles();
    MissedFiles(const MissedFiles&) = delete;
    MissedFiles& operator=(const MissedFiles&) = delete;

    [[nodiscard]] const std::set<std::string>& names() const { return names_; }

  private:
    friend void noteMissed(const std::string& name);
    MissedFiles* outer_;
    std::set<std::string> names_;
};

/// Records a file that a search expected, and did not find or may not read, in all scopes of this
/// thread; without one the call has no effect.
void noteMissed(const std::string& name);

}  // namespace ispace
