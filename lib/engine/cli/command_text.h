// SPDX-License-Identifier: GPL-3.0-or-later
// Text about a command: its help, its version, and its words in the history of a product.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ispace {

/// The page that --help prints.
struct HelpPage {
    struct Option {
        std::string heading;    ///< of the group that begins with it; "" within a group
        std::string signature;  ///< "-o, --output FILE"
        std::string text;
    };
    /// Options that the page leaves out.
    struct Group {
        std::string word, title;  ///< `--help WORD` prints them
        std::string extension;    ///< that they belong to; "" for the tool's own
    };
    std::string tool, synopsis, summary;
    std::vector<Option> options;
    std::vector<Group> groups;
    std::vector<std::pair<std::string, std::string>> examples;  ///< commands and their effects
    std::string statuses;                                       ///< meanings of the exit statuses
    bool has_extensions = false;                                ///< versionText() lists them
    std::optional<std::vector<std::string>> extensions = {};    ///< this page does, too
};

/// Formats the page in lines of at most 79 characters where words allow it.
std::string helpText(const HelpPage& page);

/// Returns the text of --version, and of --version --json.
/// \param extensions of this build, if they are known
std::string versionText(const std::string& tool,
                        const std::optional<std::vector<std::string>>& extensions);
std::string versionJson(const std::string& tool,
                        const std::optional<std::vector<std::string>>& extensions);

/// Returns the name of an operand as the history of a product has it: without folders, quoted for
/// the shell, "-" for a stream.
std::string fileInHistory(const std::string& operand);

/// Does so for `PREFIX:FILE,FILE`, or a single file.
std::string filesInHistory(const std::string& list);

}  // namespace ispace
