// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "cli/command_line.h"

namespace ispace {

/// A rule for make: `target` depends on `sources`, each named once, in their order; streams are
/// left out. Each source also stands as a target of its own without recipe, so that make goes on
/// when a file that is no longer used was deleted. Characters with a meaning in names are written
/// as make wants them. \throws UsageError for names that make cannot read: with = ; control
/// characters, two %, ~ at the beginning, or a blank, backslash or ) at the end
std::string dependencyRule(const std::string& target, std::span<const std::string> sources);

/// Checks -MD and -MF against -o. \throws UsageError for -MF alone and without a product's name
void checkDependencies(const DependencyOptions& options, const std::string& output);

/// Claims the product and its rule, see claimOutput: a tool begins with this.
void claimOutputs(const CommonOptions& options);

/// Writes the rule of -o if it is wanted. \param files all that the product was made from
void writeDependencies(const CommonOptions& options, std::span<const std::string> files);

}  // namespace ispace
