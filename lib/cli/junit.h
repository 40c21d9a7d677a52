// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <span>
#include <string>

namespace ispace {

/// One verdict, as CI servers list them.
struct JunitCase {
    enum class Outcome {
        Met,
        Unmet,  ///< judged, and not as required: a `failure`
        Error,  ///< could not be judged
    };
    std::string name;
    Outcome outcome = Outcome::Met;
    std::string message = {};            ///< why it is not met
    std::chrono::nanoseconds time = {};  ///< 0 where no time passes
};

/// The verdicts of a tool in the XML that CI servers read as JUnit's: one testsuite, whose time is
/// that of its last verdict, with a testcase each. \param suite its name, e.g. the environment's
std::string junitXml(const std::string& tool, const std::string& suite,
                     std::span<const JunitCase> cases);

}  // namespace ispace
