// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to the objectives of arrange: a word of --objective,
// options, and the demand that counts instead of the floor, or a search of its own. See
// cli/extension.h.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arrange_group.h"
#include "cli/common_options.h"
#include "cli/site_operands.h"
#include "cli/word_extension.h"

namespace ispace {

class Demand;

/// An objective of arrange and its options; help() says what the layout maximises. Without one,
/// arrange covers floor.
class ObjectiveGroup : public WordGroup {
  public:
    /// Returns what counts, for refusals of options about the floor, and those of them that hold
    /// for it, too.
    struct Counted {
        std::string_view what = "ways of people instead of floor";
        std::span<const std::string_view> options = {};  ///< of --zone, --weight, ...
    };
    [[nodiscard]] virtual Counted counted() const { return {}; }
    /// Sets ArrangeOptions::objective, for one with a search of its own, and checks the options
    /// with it; else there is a demand. \param others options of other groups that say what counts
    /// \throws UsageError
    virtual void settle(const CommandLine& /*line*/, std::span<const std::string_view> /*others*/,
                        ArrangeOptions& /*how*/) const {}
    /// Looks up what it names in a site. \pre settle() has set an objective \throws UsageError
    virtual void aim(const SiteInput& /*input*/, ArrangeOptions& /*how*/) const {}
    /// Measures the written layout. \pre as aim()
    virtual void judge(const ArrangedSite& /*site*/, ArrangeFindings& /*findings*/) const {}
    /// Makes the demand in each room of a site, all of one class; empty for an objective with a
    /// search of its own.
    /// \param goals of the rooms \param files receives those that were read \throws UsageError,
    /// UnmetError, FormatError
    [[nodiscard]] virtual std::vector<std::shared_ptr<const Demand>> demandsIn(
        const SiteInput& /*site*/, std::span<const RoomGoals> /*goals*/,
        const ArrangeOptions& /*how*/, const CommonOptions& /*common*/,
        std::vector<std::string>& /*files*/) const {
        return {};
    }
};

using ObjectiveRow = WordRow<ObjectiveGroup>;
/// The objectives that extensions add to one command line.
using ObjectiveExtensions = WordExtensions<ObjectiveGroup>;

}  // namespace ispace
