// SPDX-License-Identifier: GPL-3.0-or-later
#include "envc/envc_options.h"

#include <span>

#include "base/message.h"

namespace ispace {

std::string remediesText(const EnvcOptions& options, std::size_t findings,
                         const std::vector<Remedy>& remedies) {
    if (remedies.empty()) return findings == 0 ? "" : "no move of one thing resolves a finding\n";
    std::string text = "suggestions:\n";
    for (const Remedy& remedy : remedies) {
        text += "  " + printable(remedy.text) + ": " + std::to_string(remedy.resolved) +
                (remedy.resolved == 1 ? " finding" : " findings") + " fewer, " +
                std::to_string(findings - remedy.resolved) + " left\n";
        text += "    " + commandOf(options.changing, std::span(&remedy.edit, 1)) + '\n';
    }
    return text;
}

}  // namespace ispace
