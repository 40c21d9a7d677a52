// SPDX-License-Identifier: GPL-3.0-or-later
// Verdicts for CI servers: the file of --junit, written with the outcome or with the error.
//
//     JunitFile junit("coverage", options.junit);
//     junit.during(options.operands, [&] { junit.write("room.env", judge(options)); });
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "base/file.h"

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
    std::chrono::nanoseconds time = {};  ///< 0 if not timed
};

/// Writes the verdicts of a tool in the XML that CI servers read as JUnit's: one testsuite, with
/// the time of its last verdict and a testcase for each. \param suite its name, e.g. the
/// environment's
std::string junitXml(const std::string& tool, const std::string& suite,
                     std::span<const JunitCase> cases);

/// The file of --junit, which is written whether or not the run succeeds.
class JunitFile {
  public:
    /// \param file "": no file \throws std::system_error, UsageError as OutputFile
    JunitFile(std::string tool, const std::string& file);

    /// Writes the verdicts of a suite, once.
    void write(const std::string& suite, std::span<const JunitCase> cases);
    /// Runs a tool's work. If it throws before write(), the file holds one case, an `error` with
    /// the messages, named after the tool and `inputs`, its operands; the exception is rethrown.
    void during(std::span<const std::string> inputs, const std::function<void()>& work);

  private:
    std::string tool_;
    std::optional<OutputFile> file_;  // until it is written
};

}  // namespace ispace
