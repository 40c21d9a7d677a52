// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/ifc/building.h"
#include "io/ifc/step_file.h"

namespace ispace {

/// How the elements of a building belong together, by its IfcRel… instances.
class IfcTree {
  public:
    explicit IfcTree(const StepFile& file);

    /// The nearest instance of this type above, by aggregation, containment, holes and fillings; 0
    /// if there is none. Loops end.
    [[nodiscard]] StepId above(StepId id, std::string_view type) const;
    /// Its name, or "".
    [[nodiscard]] std::string nameAbove(StepId id, std::string_view type) const;
    /// The element that a hole is in; 0 if the file does not say.
    [[nodiscard]] StepId hostOf(StepId hole) const;
    /// The door or window in a hole, or 0.
    [[nodiscard]] StepId fillerOf(StepId hole) const;
    [[nodiscard]] bool fillsHole(StepId door) const { return filled_.contains(door); }
    /// Areas of a space in quantities and properties, in the file's unit: those of its floor first.
    [[nodiscard]] std::vector<StatedArea> areasOf(StepId space) const;

  private:
    void addAreas(StepId definition, std::vector<StatedArea>& areas) const;

    const StepFile& file_;
    std::unordered_map<StepId, StepId> parent_;
    std::unordered_map<StepId, StepId> host_, filler_, filled_;
    std::unordered_map<StepId, std::vector<StepId>> definitions_;  // of spaces
};

}  // namespace ispace
