// SPDX-License-Identifier: GPL-3.0-or-later
// The page of --report.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "arrange/arrange_run.h"
#include "cli/arrange_group.h"

namespace ispace {

/// Returns the files of --heat with the map of a sensor, counted from 1: one, or of a building one
/// for each storey if the name has %s for it.
std::vector<std::string> heatFiles(const ArrangeToolOptions& options, const ArrangeWork& work,
                                   std::size_t number);
/// Draws Arrangement::gains, a picture for each sensor, to the files of --heat. That of a building
/// is a page with its storeys, or a file for each.
void writeHeat(const ArrangeToolOptions& options, const ArrangeWork& work,
               const Arrangement& arrangement);

/// Returns the bytes of --report: the coverage of a layout that was found, as coverage --report
/// writes it, with the result of the search.
/// \param layout that was written \param command as in histories
std::string reportFile(const ArrangeToolOptions& options, const ArrangeWork& work,
                       const Arrangement& arrangement, const Document& layout,
                       const std::string& command);

/// Writes the lists that go with a report, such as --material, with their warnings.
void writeReportLists(const ArrangeToolOptions& options, const ArrangeWork& work,
                      const Arrangement& arrangement, const Document& layout);

/// Measures an objective with a search of its own on the written layout; empty without one.
ArrangeFindings figuresOf(const ArrangeToolOptions& options, const ArrangeWork& work,
                          const Arrangement& arrangement);

/// Returns what groups of extensions find out about the written layout.
ArrangeFindings findingsOf(const ArrangeToolOptions& options, const ArrangeWork& work,
                           const Arrangement& arrangement);

}  // namespace ispace
